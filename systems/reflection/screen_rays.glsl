// Rays through the picture: what the mirrored direction of a pixel meets among what the camera sees (Sousa et al. 2011,
// "Secrets of CryENGINE 3"; steps equal on screen, McGuire and Mara 2014, JCGT 3(4)). Several rays fan out along the plane
// of incidence, where the lobe is long; across it, and between them, a pyramid of the picture blurs.
#ifndef SYSTEMS_REFLECTION_SCREEN_RAYS_GLSL
#define SYSTEMS_REFLECTION_SCREEN_RAYS_GLSL
#include "systems/reflection/stand_ins.glsl"

layout(binding = 9) uniform sampler2D picture_pyramid;  // half size and smaller
uniform int ray_count, ray_steps;

const float longest_ray_m = 120.0;

// Distance along the ray to what it meets, and how sure; x < 0: nothing. uv: where in the picture.
vec2 march(vec3 from, vec3 way, float jitter, out vec2 uv) {
  vec4 h0 = frame.view_projection * vec4(from, 1.0);
  vec4 h1 = frame.view_projection * vec4(from + way * longest_ray_m, 1.0);
  float reach = longest_ray_m;
  if (h1.w < 0.2) {  // towards the camera: stop before it
    float part = (h0.w - 0.2) / max(h0.w - h1.w, 1e-6);
    reach *= part;
    h1 = mix(h0, h1, part);
  }
  vec2 p0 = h0.xy / h0.w, p1 = h1.xy / h1.w;
  float k0 = 1.0 / h0.w, k1 = 1.0 / h1.w;
  vec2 d = p1 - p0;
  vec2 leave = (mix(vec2(-1.0), vec2(1.0), greaterThan(d, vec2(0.0))) - p0) / (abs(d) + 1e-9) * sign(d + 1e-12);
  float last = clamp(min(leave.x, leave.y), 0.0, 1.0);
  uv = p0 * 0.5 + 0.5;
  float before = 0.0, found = -1.0, jump = 0.0;
  for (int i = 0; i < ray_steps; ++i) {
    float x = (float(i) + jitter) / float(ray_steps);
    float s = last * x * (0.4 + 0.6 * x);  // finer near the surface, for contact
    float depth = texelFetch(gbuffer_depth, ivec2((mix(p0, p1, s) * 0.5 + 0.5) * frame.size.xy), 0).r;
    float ray_m = 1.0 / mix(k0, k1, s), surface_m = axial_distance_m(max(depth, 1e-7));
    float thick = 0.4 + 0.02 * ray_m + abs(ray_m - 1.0 / mix(k0, k1, before));
    bool hit = depth > 0.0 && ray_m > surface_m * 1.002 + 0.01 && ray_m < surface_m + thick;
    if (hit) {
      found = s;
      break;
    }
    before = s;
  }
  if (found < 0.0) return vec2(-1.0, 0.0);
  for (int i = 0; i < 5; ++i) {
    float s = 0.5 * (before + found);
    float depth = texelFetch(gbuffer_depth, ivec2((mix(p0, p1, s) * 0.5 + 0.5) * frame.size.xy), 0).r;
    bool behind = depth > 0.0 && 1.0 / mix(k0, k1, s) > axial_distance_m(depth) * 1.002 + 0.01;
    if (behind) found = s;
    else before = s;
  }
  vec2 p = mix(p0, p1, found);
  uv = p * 0.5 + 0.5;
  ivec2 texel = clamp(ivec2(uv * frame.size.xy), ivec2(0), ivec2(frame.size.xy) - 1);
  float depth = texelFetch(gbuffer_depth, texel, 0).r;
  float ray_m = 1.0 / mix(k0, k1, found), surface_m = axial_distance_m(max(depth, 1e-7));
  // Behind the edge of something near: nobody knows what is there.
  float sure = 1.0 - smoothstep(0.3, 0.6 + 0.03 * ray_m, abs(ray_m - surface_m));
  vec3 n = unit_from_octahedral(texelFetch(gbuffer_normal, texel, 0).xy * 2.0 - 1.0);
  sure *= 1.0 - smoothstep(-0.1, 0.15, dot(n, way));  // seen from behind
  vec2 border = smoothstep(vec2(0.0), vec2(0.06), 0.5 - abs(uv - 0.5));
  sure *= border.x * border.y;
  float metres = found * k1 / max(mix(k0, k1, found), 1e-9) * reach;  // perspective: distance along the ray
  return vec2(metres, sure);
}

// rgb: the picture as mirrored, weighed by how sure that is; a: how sure.
vec4 screen_space(Facing at, Lobe lobe, float jitter) {
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  vec3 from = at.place + at.normal * (0.01 + 0.002 * length(at.place));
  for (int i = 0; i < ray_count; ++i) {
    // Slopes of GGX along one axis: density a^2 / (2 (a^2 + x^2)^1.5), so x = a s / sqrt(1 - s^2), s even in -1 to 1.
    float s = clamp(2.0 * (float(i) + jitter) / float(ray_count) - 1.0, -0.96, 0.96);
    float slope = at.alpha * s * inversesqrt(1.0 - s * s);
    vec3 h = normalize(at.normal + lobe.t * slope);
    vec2 passes = facet_weight(vec2(slope, 0.0), lobe.v_local, at.a2);
    vec3 way = reflect(-at.view, h);
    float weight = dot(way, at.normal) > 0.002 ? passes.x * fresnel(at.f0, passes.y, at.dielectric).g : 0.0;
    weights += weight;
    if (weight <= 0.0) continue;
    vec2 uv;
    vec2 met = march(from, way, jitter, uv);
    if (met.x < 0.0 || met.y <= 0.0) continue;
    // Half the angles that the lobe fills across the plane of incidence, and that one of the rays stands for in it.
    float across = 2.0 * at.alpha * max(at.n_dot_v, 0.05), within = 4.0 * at.alpha / float(ray_count);
    vec3 place = from + way * met.x;
    float pixels = met.x * max(across, within) / max(length(place), 0.1) * frame.lens.z;
    float level = clamp(log2(max(0.5 * pixels, 1.0)), 0.0, 6.0);
    sum += vec4(textureLod(picture_pyramid, uv, level).rgb, 1.0) * (weight * met.y);
  }
  return sum / max(weights, 1e-6);
}

#endif
