#pragma once
// Light from above by what is no light of the scene, as a map of the ground about the camera (section 3.3's overhead
// illumination texture).

#include <memory>

#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"

namespace petrichor {

struct OverheadState {
  Buffer glows;
  glm::dvec2 middle_m{0.0};  // world x and z
  float reach_m = 0.0f;       // about the camera, where the picture is drawn
};
constexpr double overhead_side_m = 64.0, overhead_step_m = 8.0;

// Pass splash_overhead: drawn for each frame, about a middle that moves by whole steps.
PassOffer overhead_pass(std::shared_ptr<OverheadState>);
// Uniform of splash.glsl: middle relative to the camera, side, and what is taken off.
glm::vec4 overhead_place(const OverheadState&, const Frame&, float known_lux);
// Irradiance by the same glows where the camera is: the environment, captured there, shows it already.
float overhead_at_camera(const Frame&);

}  // namespace petrichor
