#version 450 core
// Lays films of water over the G-buffer, in place: darker base, smoother and flatter surface. LEVEL: 0 standing water
// alone, 1 one film everywhere, 2 by exposure, 3 with films that run. MASK: the G-buffer knows kinds of material.
// STANDING: there are puddles.
#define GBUFFER_WRITER
#include "systems/geometry/gbuffer.glsl"
#include "systems/wetness/optics.h"
#include "systems/wetness/wetness_shared.h"
#if LEVEL >= 2
#include "systems/wetness/exposure.glsl"
#include "systems/wetness/flow.glsl"
#endif
#ifdef MASK
#include "systems/wet_materials.glsl"
#endif
#ifdef STANDING
#define RIPPLE_UNIT 8
#include "systems/puddle/puddle.glsl"
#include "systems/ripple/ripple.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D depth_texture;
layout(binding = 0, rgba8) uniform image2D albedo_image;
layout(binding = 1, rgba16) uniform image2D normal_image;
layout(binding = 2, rg16f) uniform writeonly image2D water_image;
#ifdef MASK
layout(binding = 1) uniform sampler2D mask_texture;
#endif
layout(std140, binding = WETNESS_UNIFORMS_BINDING) uniform WetnessBlock { WetnessGpu wetness; };
layout(std430, binding = WETNESS_FILMS_BINDING) readonly buffer FilmBlock { uvec2 films[]; };  // four halves each

const float film_exposures = 24.0, film_porosities = 4.0, remembered_exposures = 6.0, most_exposure = 4.0;

// The plane of the surface itself, without its relief, from the depths of four pixels alone: near / depth is the axial
// distance, and over a plane its inverse, so depth itself, is linear in the picture. slope: of the depth, a pixel.
// World, unit, towards the viewer.
vec3 plane_normal(vec2 pixel, float depth, vec2 slope) {
  // View ray (x, y, -1) with x, y linear in the pixel; n . ray / c = 1 / distance.
  vec2 lens = vec2(frame.lens.x * frame.lens.y, frame.lens.x);
  vec2 ray = ndc_of_pixel(pixel) * lens;
  vec2 n = slope * frame.size.xy / (2.0 * lens);
  return normalize(-(vec3(n, dot(n, ray) - depth) * mat3(frame.view)));
}

#if LEVEL >= 1
struct Wet {
  float film_m;
  float soaked;  // filling of the pores
};

// Of the table, between its exposures; of porosities the nearest, for a material has one.
vec4 film_row(float row, float exposure_index) {
  float i = min(floor(exposure_index), film_exposures - 2.0);
  int base = int(row * film_exposures + i);
  uvec2 a = films[base], b = films[base + 1];
  return mix(vec4(unpackHalf2x16(a.x), unpackHalf2x16(a.y)), vec4(unpackHalf2x16(b.x), unpackHalf2x16(b.y)),
             exposure_index - i);
}

vec4 film_of(float porosity, float e, float remembered) {
  float row = floor(porosity * (film_porosities - 1.0) + 0.5) * wetness.spread.w;
  float x = pow(clamp(e / most_exposure, 0.0, 1.0), 1.0 / 3.0) * (film_exposures - 1.0);
  vec4 found = film_row(row, x);
  for (int once = 0; once < (wetness.spread.w > 1.0 && remembered > 0.0 ? 1 : 0); ++once) {
    float y = pow(clamp(remembered / most_exposure, 0.0, 1.0), 1.0 / 3.0) * (remembered_exposures - 1.0);
    float j = min(floor(y), remembered_exposures - 2.0);
    found = mix(film_row(row + j, x), film_row(row + j + 1.0, x), y - j);
  }
  return found;
}

Wet wet_of(vec4 row, float slope) {
  float t = clamp(log(max(slope, 0.02) * 50.0) * (2.0 / 3.912023), 0.0, 2.0);
  float film = t < 1.0 ? mix(row.x, row.y, t) : mix(row.y, row.z, t - 1.0);
  return Wet(film * 1e-3, row.w);
}
#endif

#if LEVEL >= 1
// Of a film's own surface, ruffled by the drops that hit it (alpha^2 grows by twice the variance of slopes).
float film_roughness_of(float film_m) {
  float ruffled = film_slope_rms(wetness.open_film.w, film_m);
  return sqrt(sqrt(1.6e-5 + 2.0 * ruffled * ruffled));
}
#endif

#if LEVEL >= 2
const float far_m = 60.0;

// What four pixels share, or those of them that lie in one plane.
struct Place {
  vec3 at;  // m relative to the camera
  vec3 plane;
  bool planar;
  float exposed;
  float slope;  // sine of its inclination
  float film_m, soaked, wetted, film_roughness;
};

Place place_at(ivec2 texel, vec2 pixel, float depth, vec2 depth_slope, bool planar) {
  Place p;
  vec4 stored = imageLoad(normal_image, texel);
  vec3 shaded = unit_from_octahedral(stored.xy * 2.0 - 1.0);
  p.at = relative_position(pixel, depth);
  p.plane = plane_normal(pixel, depth, depth_slope);
  // Where the plane is not what is shaded (an edge between two surfaces, a card of leaves), the shading's.
  if (!planar || dot(p.plane, shaded) < 0.6) p.plane = shaded;
  float porosity = porosity_of_roughness(stored.z);
#ifdef MASK
  porosity = porosity_of(wet_materials[wet_kind(texelFetch(mask_texture, texel, 0).rg)], stored.z);
#endif
  // Far away no edge of a shelter is told from another.
  p.exposed = max(p.plane.y, 0.0);
  float before = 0.0;
  bool near = dot(p.at, p.at) < far_m * far_m;
  for (int once = 0; once < (near ? 1 : 0); ++once) p.exposed = exposure(p.at, p.plane, wetness.spread.xyz);
  for (int once = 0; once < (near && wetness.spread.w > 1.0 ? 1 : 0); ++once)
    before = remembered_exposure(p.at, p.plane, wetness.spread.xyz);
  p.slope = sqrt(max(1.0 - p.plane.y * p.plane.y, 0.0));
  Wet w = wet_of(film_of(porosity, p.exposed, before), p.slope);
  // The rung of one film everywhere gives way to this one.
  float elsewhere = wetness.shares.x / max(dot(wetness.shares.xyz, vec3(1.0)), 1e-6);
  p.film_m = mix(w.film_m, wetness.open_film.x * 1e-3, elsewhere);
  p.soaked = mix(w.soaked, wetness.open_film.y, elsewhere);
  p.wetted = wetted_share(p.film_m);
  p.film_roughness = film_roughness_of(p.film_m * max(p.plane.y, 0.0));
  return p;
}
#define OF_PLACE Place shared_place
#else
#define OF_PLACE float unused
#endif

// One pixel; returns mm of standing water and of film.
vec2 wet_pixel(ivec2 texel, float depth, OF_PLACE) {
  vec2 water_mm = vec2(0.0);
  vec4 stored_albedo = imageLoad(albedo_image, texel);
  vec4 stored_normal = imageLoad(normal_image, texel);
  Surface s = decode_surface(stored_albedo, stored_normal, vec3(0.0));
  float roughness = s.roughness;
  float porosity = porosity_of_roughness(roughness);
  float takes = takes_film(roughness, s.metallic);
#ifdef MASK
  vec2 mask = texelFetch(mask_texture, texel, 0).rg;
  uint kind = wet_kind(mask);
  porosity = porosity_of(wet_materials[kind], roughness);
  if (kind == 0u) takes = 0.0;
#endif
  Surface dry = s;
#if LEVEL >= 2 || defined(STANDING)
  vec3 place = relative_position(vec2(texel) + 0.5, depth);
#endif
#ifdef STANDING
  StandingWater standing = standing_water(place, mask);
#endif
#if LEVEL == 1
  vec3 plane = s.normal;
  Wet w = Wet(wetness.open_film.x * 1e-3, wetness.open_film.y);
#elif LEVEL >= 2
  vec3 plane = shared_place.planar ? shared_place.plane : s.normal;
  float e = shared_place.exposed, slope = shared_place.slope;
  Wet w = Wet(shared_place.film_m, shared_place.soaked);
#endif
#if LEVEL >= 1
  float strength = clamp(dot(wetness.shares.xyz, vec3(1.0)), 0.0, 1.0);
  vec3 film_normal = plane;
#if LEVEL == 3
  // Both patterns where either is: walls and slopes have few pixels in common.
  vec3 world = place + wetness.world_from_camera.xyz;
  float share = wetness.shares.z / max(dot(wetness.shares.xyz, vec3(1.0)), 1e-6);
  float footprint = -dot(place, vec3(frame.view[0].z, frame.view[1].z, frame.view[2].z)) / frame.lens.z;
  footprint /= max(abs(dot(plane, normalize(place))), 0.1);
  bool wall = slope > 0.7 && w.film_m > 2e-6, ground = slope < 0.5 && w.film_m > 5e-5;
  for (int once_more = 0; once_more < (wall ? 1 : 0); ++once_more) {
    vec3 level = normalize(vec3(plane.z, 0.0, -plane.x));
    Flow flow = wall_flow(dot(world, level), world.y, wetness.flown.y, footprint);
    film_normal = normalize(plane - level * (flow.slope.x * share));
    w.film_m *= mix(1.0, flow.thickness, share);
  }
  for (int once_more = 0; once_more < (ground ? 1 : 0); ++once_more) {
    vec2 way = plane.xz / max(length(plane.xz), 1e-4);
    float steep = clamp(slope * 25.0 - 0.2, 0.0, 1.0) * share;
    Flow flow = slope_flow(world.xz, way, wetness.flown.x, footprint);
    vec2 tilt = (flow.slope.y * way + flow.slope.x * vec2(-way.y, way.x)) * steep;
    film_normal = normalize(plane - vec3(tilt.x, 0.0, tilt.y));
    w.film_m *= mix(1.0, flow.thickness, steep);
  }
#endif
  float film_m = w.film_m;
#ifdef STANDING
  if (standing.depth_m > 0.0) w = Wet(max(w.film_m, standing.depth_m), 1.0);
#endif
#if LEVEL == 2 && !defined(STANDING)
  float wetted = shared_place.wetted * takes * strength;
#else
  float wetted = wetted_share(w.film_m) * takes * strength;
#endif
  float soaked = w.soaked * takes * strength;
  float drowned = drowned_share(w.film_m, relief_m(roughness)) * takes * strength;
  s.albedo = wet_base_colour(s.albedo, porosity, soaked, wetted);
  s.water = wetted;
  // Pits smaller than the film fill up everywhere; where it drowns the relief its own surface is seen.
#if LEVEL == 1
  float film_roughness = film_roughness_of(w.film_m * max(plane.y, 0.0));
#else
  float film_roughness = shared_place.film_roughness;
#endif
  s.roughness = mix(roughness * (1.0 - 0.25 * wetted), min(film_roughness, roughness), drowned);
  // What a normal map shows is coarser than roughness: bumps of a millimetre, which the film follows until they drown.
  float flattened = drowned_share(w.film_m, relief_m(roughness) + MAPPED_RELIEF_M) * takes * strength;
  s.normal = normalize(mix(s.normal, film_normal, flattened));
  water_mm.y = film_m * 1e3 * strength;
#if LEVEL == 1
  if (wetness.open_film.z > 0.5) {  // as published
    float wet = strength * clamp(wetness.open_film.x * 2.0, 0.0, 1.0);
    float factor = published_factor(porosity, s.metallic);
    s.albedo = dry.albedo * mix(1.0, factor, wet);
    s.roughness = 1.0 - published_gloss(1.0 - roughness, factor, wet);
    s.normal = dry.normal;
  }
#endif
#endif
#ifdef STANDING
  for (int once_more = 0; once_more < (standing.depth_m > 0.0 ? 1 : 0); ++once_more) {
#if LEVEL == 0
    float soaked = wetted_share(standing.depth_m) * takes;
    s.albedo = wet_base_colour(s.albedo, porosity, soaked, soaked);
    float open = 1.0;
#elif LEVEL == 1
    float open = 1.0;
#else
    float open = clamp(e, 0.0, 1.0);
#endif
    // alpha^2 grows by twice the variance of slopes along either way.
    float unseen = film_slope_rms(wetness.open_film.w, standing.depth_m) * open;
    unseen *= unseen;
    vec2 waves = vec2(0.0);
    for (int rings = 0; rings < (wetness.flown.z > 0.5 ? 1 : 0); ++rings) {
      Ripples found = ripples_at(place, standing.ripple_scale, standing.ripple_turn_rad, open);
      waves = found.slope;
      unseen = 0.5 * found.variance;
    }
    s = under_water(s, standing, -normalize(place), waves, sqrt(sqrt(1.6e-5 + 2.0 * unseen)));
    water_mm.x = standing.depth_m * 1e3;
  }
#endif
  s.roughness = max(s.roughness, 0.04);
  imageStore(albedo_image, texel, encode_albedo(s));
  imageStore(normal_image, texel, encode_normal(s));
  return water_mm;
}

// Four pixels an invocation: how much rain they get, and the film that follows, they share where they lie in one plane;
// else the nearest and the farthest of them have their own.
void main() {
  ivec2 corner = ivec2(gl_GlobalInvocationID.xy) * 2, size = ivec2(frame.size.xy);
  bool inside = all(lessThan(corner, size));
  ivec2 last = min(corner + 1, size - 1);
  ivec2 texels[4] = ivec2[4](corner, ivec2(last.x, corner.y), ivec2(corner.x, last.y), last);
  vec4 depth = vec4(0.0);
  for (int i = 0; i < 4; ++i) depth[i] = inside ? texelFetch(depth_texture, texels[i], 0).r : 0.0;
  float nearest = max(max(depth.x, depth.y), max(depth.z, depth.w));
  float farthest = min(min(depth.x, depth.y), min(depth.z, depth.w));
  vec2 water[4] = vec2[4](vec2(0.0), vec2(0.0), vec2(0.0), vec2(0.0));
  // A loop for an if: software OpenGL leaves a loop that no pixel is in, but walks through both sides of a branch.
  for (int once = 0; once < (nearest > 0.0 ? 1 : 0); ++once) {
#if LEVEL >= 2
    vec2 slope = vec2(depth.y + depth.w - depth.x - depth.z, depth.z + depth.w - depth.x - depth.y) * 0.5;
    bool planar = abs(depth.x + depth.w - depth.y - depth.z) < 2e-3 * nearest && farthest > 0.7 * nearest;
    int first = depth.x == nearest ? 0 : depth.y == nearest ? 1 : depth.z == nearest ? 2 : 3;
    vec2 pixel = planar ? vec2(corner) + 1.0 : vec2(texels[first]) + 0.5;
    Place near = place_at(texels[first], pixel, planar ? 0.25 * dot(depth, vec4(1.0)) : nearest, slope, planar);
    Place far = near;
    // What lies close behind is seen through a seam of the mesh, or joins it at a crease: it is as wet.
    bool apart = !planar && farthest < 0.9 * nearest;
    for (int again = 0; again < (apart && farthest > 0.0 ? 1 : 0); ++again) {
      int other = depth.x == farthest ? 0 : depth.y == farthest ? 1 : depth.z == farthest ? 2 : 3;
      far = place_at(texels[other], vec2(texels[other]) + 0.5, farthest, slope, false);
    }
    float middle = 0.5 * (nearest + farthest);
#endif
    for (int i = 0; i < 4; ++i) {
      if (depth[i] <= 0.0) continue;
#if LEVEL >= 2
      Place own = near;
      if (depth[i] < middle && apart) own = far;
      own.planar = planar;
      water[i] = wet_pixel(texels[i], depth[i], own);
#else
      water[i] = wet_pixel(texels[i], depth[i], 0.0);
#endif
    }
  }
  if (!inside || wetness.flown.w < 0.5) return;
  for (int i = 0; i < 4; ++i) imageStore(water_image, texels[i], vec4(water[i], 0.0, 0.0));
}
