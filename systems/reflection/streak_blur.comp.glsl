#version 450 core
// One step of the vertical streak: Kawase's growing filter (Kawase 2003, "Frame Buffer Postprocessing Effects in
// DOUBLE-S.T.E.A.L"), in passes of its own (Tatarchuk and Isidoro 2006, sections 6.2 and 6.3).
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D source;
layout(binding = 0, rgba16f) uniform writeonly image2D blurred;
uniform float offset;  // texels, grows from step to step

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(blurred);
  if (any(greaterThanEqual(texel, size))) return;
  vec2 at = (vec2(texel) + 0.5) / vec2(size), down = vec2(0.0, 1.0 / float(size.y));
  vec4 sum = textureLod(source, at + down * offset, 0.0) + textureLod(source, at - down * offset, 0.0) +
             textureLod(source, at + down * 3.0 * offset, 0.0) + textureLod(source, at - down * 3.0 * offset, 0.0);
  imageStore(blurred, texel, 0.25 * sum);
}
