// Structs that C++ and GLSL share: included by both. std140 (uniforms) and std430 (lights) agree with the
// C++ layout because every member is a vec4, a mat4 or part of a group of four scalars.
#ifndef PETRICHOR_FRAME_SHARED_H
#define PETRICHOR_FRAME_SHARED_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace petrichor {
using glm::ivec4;
using glm::mat4;
using glm::uvec4;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;
#endif

// Fixed binding points. Textures and images are bound per pass.
#define FRAME_UNIFORMS_BINDING 0  // uniform block FrameBlock { FrameUniforms frame; }
#define LIGHTS_BINDING 0          // buffer, LightGpu lights[]
#define OCCLUSION_UNIFORMS_BINDING 1  // uniform block, OcclusionUniforms (systems/occlusion)
#define OCCLUSION_MAPS 16         // at most
#define OCCLUSION_UNIT 15         // texture unit of the occlusion maps in shaders that include occlusion.glsl

#define RAIN_ONSET_PAIRS 7

#define LIGHT_POINT 0
#define LIGHT_SPOT 1
#define LIGHT_DIRECTIONAL 2

// One frame's constants. Positions are metres relative to `origin_m` = the camera's position (camera-relative
// world space), so that precision does not depend on how far the camera is from the world's origin.
struct FrameUniforms {
  mat4 view_projection;          // camera-relative world -> clip; reversed z (near 1, far 0), infinite far
  mat4 inverse_view_projection;  // clip -> camera-relative world
  mat4 view;                     // camera-relative world -> view (rotation only)
  mat4 shutter_view_projection;  // as view_projection but of the camera when the shutter opened; maps points
                                 // relative to the *current* camera position
  vec4 camera_world_m;           // xyz position in the world (single precision), w: near_m
  vec4 camera_velocity_mps;      // xyz, w: exposure_s
  vec4 size;                     // width, height, 1/width, 1/height (pixels)
  vec4 lens;                     // tan(fov_y/2), aspect, pixels per radian at the centre, exposure scale (cd/m2 -> linear output)
  vec4 time;                     // seconds (wrapped at 3600), frame number mod 2^20, simulation step, 0
  vec4 sky_zenith;               // cd/m2, w: ambient multiplier
  vec4 sky_horizon;              // cd/m2, w: glow height
  vec4 mist;                     // extinction 1/m, rgb albedo in yzw
  vec4 rain;                     // extinction 1/m of the drops that are not drawn singly beyond .y m, .y the mean of
                                 // the distances where they begin; .z extinction 1/m of what is drawn at no distance:
                                 // drops too small, and the share of fog alone; .w rain rate mm/h
  vec4 rain_onsets[RAIN_ONSET_PAIRS];  // the first four of rain, the others of snow; counts.z are in use. Each two
                                 // techniques or groups of classes: extinction 1/m of the drops that are drawn
                                 // singly out to a distance, that distance m; and again. undrawn_rain_depth() reads it
  uvec4 counts;                  // lights, instances, rain_onsets, 0
};

// Camera-relative position. Intensities are cd (lux where directional), colour included.
struct LightGpu {
  vec4 position_range;    // xyz m, w: distance at which it is cut, > 0
  vec4 intensity_radius;  // rgb cd, w: source radius m
  vec4 direction_kind;    // xyz the way it shines (unit), w: LIGHT_*
  vec4 cone_shadow;       // spot attenuation scale and offset (KHR_lights_punctual), z: shadow slot or -1, w: lights rain (0/1)
};

// The maps of shelter: scene depth along the fall directions of the precipitation, a layer each.
struct OcclusionUniforms {
  mat4 map_from_relative[OCCLUSION_MAPS];  // camera-relative world -> xy texture coordinates in 0..1, z metres along the fall
  vec4 fall_texel[OCCLUSION_MAPS];  // xyz unit fall direction in the world, w: texel edge, m; 0: there is no map
  vec4 size_depth[OCCLUSION_MAPS];  // x texels per side, y metres from depth 1 (upper end) to depth 0, z bias, m,
                                    // w share of the precipitation that falls about this way
  uvec4 counts;                     // maps; the one nearest to the mean fall; how many were redrawn; of remembered falls, behind the maps
};

#ifdef __cplusplus
static_assert(sizeof(FrameUniforms) == 4 * 64 + (10 + RAIN_ONSET_PAIRS) * 16);
static_assert(sizeof(LightGpu) == 64);
static_assert(sizeof(OcclusionUniforms) == 96 * OCCLUSION_MAPS + 16);
}  // namespace petrichor
#endif
#endif
