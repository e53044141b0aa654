#pragma once
// The mirrored camera: where a plane's mirror image stands in the picture, and which planes a frame may mirror.

#include <glm/glm.hpp>
#include <span>

#include "systems/frame.hpp"
#include "systems/mirror_frame.hpp"
#include "systems/mirror_shared.h"

namespace petrichor {

// A place relative to the camera -> clip space of the picture that shows its mirror image in the plane. x is turned, so
// that triangles keep their winding. Reversed depth, 1 on the plane itself, falling with the distance from the mirrored
// eye, above 0 for all that can be in view: Lengyel's clip plane ("Oblique View Frustum Depth Projection and Clipping",
// 2005) for a depth of 1 to 0 with no far plane. Nothing behind the plane is drawn.
glm::dmat4 mirrored_clip(const FrameCamera&, double aspect, const FrameMirrors::Plane&);

// The part of the picture that the plane's image covers (0..1, padded), as MirrorGpu::rect.
glm::vec4 mirrored_rect(const FrameMirrors::Plane&);

// MirrorsGpu of the frame. Texels that are used, texels and levels of the texture.
MirrorsGpu mirrors_of(const Frame&, const glm::ivec2& used, const glm::ivec2& texture, int levels);

// What of the picture a convex polygon covers.
struct OnScreen {
  float share = 0.0f;                // of the picture's area
  glm::vec2 low{1.0f}, high{-1.0f};  // its box in -1..1; low > high: it is not in view
};
// Corners relative to the camera.
OnScreen on_screen(const glm::mat4& view_projection, std::span<const glm::vec3> corners);

}  // namespace petrichor
