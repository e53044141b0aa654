#version 450 core
// One level of the bloom pyramid from the next finer: four bilinear taps, 4x4 texels with the weights of a tent
// (1 3 3 1)/8 in each direction. The weights sum to one: no light is lost or made.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D fine;
layout(binding = 0, rgba16f) uniform writeonly image2D coarse;
uniform float level;
uniform vec2 fine_size;
uniform ivec2 size;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, size))) return;
  // In texels of the finer level, about the centre of the 2x2 block below this texel; a bilinear tap 0.75 off the
  // centre line weighs its two texels 3:1.
  vec2 centre = (vec2(texel) + 0.5) * fine_size / vec2(size);
  vec3 sum = vec3(0.0);
  sum += textureLod(fine, (centre + vec2(-0.75, -0.75)) / fine_size, level).rgb;
  sum += textureLod(fine, (centre + vec2(0.75, -0.75)) / fine_size, level).rgb;
  sum += textureLod(fine, (centre + vec2(-0.75, 0.75)) / fine_size, level).rgb;
  sum += textureLod(fine, (centre + vec2(0.75, 0.75)) / fine_size, level).rgb;
  imageStore(coarse, texel, vec4(sum * 0.25, 1.0));
}
