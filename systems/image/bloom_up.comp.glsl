#version 450 core
// Adds a coarser level, enlarged, to a finer one: level = (1 - share) * level + share * coarser. From the top
// down this gives level k the weight (1 - share) share^k: a sum of Gaussians two apart in width, which is the
// 1/angle veil of a lens (shared physics section 4c).
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D coarse;
layout(binding = 0, rgba16f) uniform image2D fine;
uniform float level;  // the coarser one
uniform vec2 coarse_size;
uniform ivec2 size;
uniform float share;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, size))) return;
  vec2 place = (vec2(texel) + 0.5) / vec2(size);
  vec2 step = 0.5 / coarse_size;
  vec3 sum = textureLod(coarse, place + vec2(-step.x, -step.y), level).rgb;
  sum += textureLod(coarse, place + vec2(step.x, -step.y), level).rgb;
  sum += textureLod(coarse, place + vec2(-step.x, step.y), level).rgb;
  sum += textureLod(coarse, place + vec2(step.x, step.y), level).rgb;
  imageStore(fine, texel, vec4(mix(imageLoad(fine, texel).rgb, sum * 0.25, share), 1.0));
}
