#pragma once
// Which planes a frame mirrors and which objects carry probes: functions of the frame alone, so that no picture depends
// on the frames before it.

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "systems/frame.hpp"
#include "systems/mirror_frame.hpp"

namespace petrichor {

// How sure a choice is: 0 where another is as large, 1 where it is a quarter larger. In place of a memory of the choice
// before: where two planes compete, the image fades out and that of the other fades in.
float dominance(float first, float second);

// The level about which most of the standing water in view lies (frame.puddles); else, in the rain, the street's.
std::optional<FrameMirrors::Plane> water_plane(const Frame&);

struct MirrorPane {
  glm::mat4 world{1.0f};  // a rectangle in its x and y
  glm::vec2 size_m{1.0f};
};
// The plane of which panes cover most of the picture; panes in one plane count together.
std::optional<FrameMirrors::Plane> pane_plane(const Frame&, std::span<const MirrorPane>);

// Those of the objects that get a cube map, nearest first, with their shares and coverage.
std::vector<FrameMirrors::Probe> nearest_probes(const Frame&, std::vector<FrameMirrors::Probe>);

}  // namespace petrichor
