// What pass wet_surfaces hands to its shader, shared by C++ and GLSL (std140, groups of four).
#ifndef PETRICHOR_WETNESS_SHARED_H
#define PETRICHOR_WETNESS_SHARED_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace petrichor {
using glm::vec4;
#endif

#define WETNESS_UNIFORMS_BINDING 26  // uniform block WetnessBlock { WetnessGpu wetness; }
#define WETNESS_FILMS_BINDING 26     // buffer FilmBlock { uvec2 films[]; }: FrameWetness::films as halves

struct WetnessGpu {
  vec4 shares;      // of the rungs everywhere, sheltered, flowing; w 0
  vec4 open_film;   // of open level ground: mm of film, filling of its pores; z: 1 as published; w mm/h that falls
  vec4 spread;      // xyz level, along the mean wind: deviation of the tilt of what falls; w: exposures of the
                    // remembered fall in the table (1: there is none)
  vec4 flown;       // metres that films have flown: down a street, down a wall (both wrapped at FLOW_WRAP_M);
                    // z, w: 1 where slots ripples and water are filled
  vec4 world_from_camera;  // xyz: the camera's place, wrapped at FLOW_WRAP_M, so that noise keeps its precision
};

#define FLOW_WRAP_M 1024.0

#ifdef __cplusplus
}  // namespace petrichor
#endif
#endif
