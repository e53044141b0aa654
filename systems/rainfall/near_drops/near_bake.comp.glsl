#version 450 core
// Pre-processing step of Rana's algorithm: makes all maps, "placing a raindrop in the middle of the small cube", with
// four interactions of ray and surface: the outer reflection has one, straight through two, one inner reflection three,
// two of them four.
layout(local_size_x = 64) in;
#include "systems/rainfall/near_drops/near_maps.glsl"

layout(std430, binding = NEAR_MAPS_BINDING) writeonly buffer NearMaps { uint maps[]; };
uniform bool on_cube;  // printed: where the ray meets the huge cube; else its direction
uniform uint texels;

vec2 octahedral(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  vec2 s = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * s;
}

void main() {
  uint texel = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
  if (texel >= texels) return;
  uint area = uint(map_pixels * map_pixels);
  vec3 middle = cell_middle(texel / area), d = normalize(middle), right, up;
  image_axes(d, right, up);
  uint inside_map = texel % area;
  vec2 q = (vec2(float(inside_map % uint(map_pixels)), float(inside_map / uint(map_pixels))) + 0.5) *
           (2.0 / float(map_pixels)) - 1.0;
  float b = length(q);
  vec3 o = b > 1e-5 ? (right * q.x + up * q.y) / b : right;
  b = min(b, 0.9998);
  // Exact Fresnel, each polarisation on its own (shared physics, section 3).
  float n = 1.333, in_angle = asin(b), inside = asin(b / n), c = cos(in_angle), s = cos(inside);
  float rs = (c - n * s) / (c + n * s), rp = (n * c - s) / (n * c + s);
  vec2 reflected = vec2(rs * rs, rp * rp), passing = 0.5 * (1.0 - reflected) * (1.0 - reflected);
  vec4 shares = vec4(0.5 * (reflected.x + reflected.y), passing.x + passing.y, dot(passing, reflected),
                     dot(passing, reflected * reflected));
  float through = 2.0 * (in_angle - inside), turn = 3.1415926536 - 2.0 * inside;
  float angles[4] = float[](2.0 * in_angle - 3.1415926536, through, through + turn, through + 2.0 * turn);
  for (int k = 0; k < 4; ++k) {
    vec3 w = cos(angles[k]) * d - sin(angles[k]) * o;
    if (on_cube) {
      vec3 faces = (sign(w) * (0.5 * NEAR_CUBE_M) - middle) / max(abs(w), vec3(1e-6)) * sign(w);
      w = normalize(middle + w * max(min(faces.x, min(faces.y, faces.z)), 0.0));
    }
    maps[texel * uint(NEAR_MAP_WORDS) + uint(k)] = packSnorm2x16(octahedral(w));
  }
  // Outside the disc nothing. Small shares keep more of themselves as roots.
  bool on_disc = length(q) < 1.0 + 0.7 / float(map_pixels);
  maps[texel * uint(NEAR_MAP_WORDS) + 4u] = on_disc ? packUnorm4x8(sqrt(shares)) : 0u;
}
