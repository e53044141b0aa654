#version 450 core
// One level of the mirrored picture's mip chain: the mean of four texels, of those that were drawn (alpha > 0).
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba16f) uniform readonly image2D finer;
layout(binding = 1, rgba16f) uniform writeonly image2D coarser;
uniform ivec2 finer_size, coarser_size;  // texels in use

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, coarser_size))) return;
  vec4 sum = vec4(0.0);
  float drawn = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec4 t = imageLoad(finer, min(texel * 2 + ivec2(i & 1, i >> 1), finer_size - 1));
    float weight = t.a > 0.0 ? 1.0 : 0.0;
    sum += t * weight;
    drawn += weight;
  }
  imageStore(coarser, texel, drawn > 0.0 ? sum / drawn : vec4(0.0));
}
