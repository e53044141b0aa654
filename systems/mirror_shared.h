// What planar mirrors and moving probes share between C++ and GLSL.
#ifndef SYSTEMS_MIRROR_SHARED_H
#define SYSTEMS_MIRROR_SHARED_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace petrichor {
using glm::ivec4;
using glm::mat4;
using glm::uvec4;
using glm::vec4;
#endif

#define MIRRORS_BINDING 10  // uniform block, bound by pass `mirrors`; stays bound for the passes after it
#define PROBES_BINDING 11   // uniform block, bound by pass `probes`; likewise
#define MIRROR_PLANES 2     // layer 0: still water, layer 1: a pane
#define PROBES 4
#define MIRROR_GUARD 1.08f  // the mirrored picture shows this much more than the camera sees, for ripples at its edges
#define MIRROR_FARTHEST_M 4000.0f  // what the sky counts as

// One plane. All places are relative to the camera; `picture` is the mirrored camera's picture, turned left for right
// so that it is the picture of a right-handed camera.
struct MirrorGpu {
  mat4 picture_from_relative;  // a place in the world -> clip space of the picture that shows its mirror image
  mat4 relative_from_picture;  // its inverse
  vec4 plane;                  // xyz unit normal, w: height above it = dot(xyz, place) + w, m
  vec4 rect;                   // low and high corner in the picture, 0..1: outside nothing is drawn
  vec4 more;  // x share (0: not drawn), y tolerance, m, z texels per radian at the picture's centre, w edge's width, 0..1
};

struct MirrorsGpu {
  MirrorGpu planes[MIRROR_PLANES];
  vec4 size;    // texels of the picture; the texture's (it may be larger)
  ivec4 levels; // of the texture; 0, 0, 0
};

struct ProbesGpu {
  vec4 place_radius[PROBES];  // relative to the camera, m
  vec4 more[PROBES];          // x share; 0, 0, 0
  uvec4 counts;               // probes; 0, 0, 0
};

#ifdef __cplusplus
static_assert(sizeof(MirrorGpu) == 176 && sizeof(MirrorsGpu) == 2 * 176 + 32 && sizeof(ProbesGpu) == 144);
}  // namespace petrichor
#endif
#endif
