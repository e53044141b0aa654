#pragma once
// From the emitter, the wind and the camera to the layered composite of a frame.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "components/techniques.hpp"
#include "components/weather.hpp"
#include "engine/ecs/registry.hpp"
#include "systems/frame.hpp"

namespace petrichor {

// Height of a cell of the placement texture along the fall, m, and how often it may double: towards the apexes, and
// for fast motion. The way travelled repeats where all of these do.
constexpr double layered_cell_m = 0.25;
constexpr int layered_placement = 256;  // texels along a side
constexpr int layered_levels = 5;       // of cells towards the apexes, each twice the one before
constexpr int layered_stretches = 4;    // of cells for fast motion
constexpr double layered_wrap_m = layered_cell_m * layered_placement * (1 << (layered_levels + layered_stretches));

// On the emitter's entity: the rain's way past the camera. Written by simulate_layered only.
struct LayeredMotion {
  glm::dquat turn{1.0, 0.0, 0.0, 0.0};     // FrameLayered::turn
  double travelled_m = 0.0, step_m = 0.0;  // after the last tick, and of it
  bool known = false;
  double time_s = 0.0;
  Emitter emitter;            // that the shares were made for
  std::vector<float> shares;  // of each drawn class in what is seen, by n D^4
  double fall_mps = 0.0;      // mean fall speed by these shares
};

// The least turn that takes the way of `turn` to this velocity; as it is where nothing moves (the last way is kept).
glm::dquat follow_way(const glm::dquat& turn, const glm::dvec3& velocity_mps);

// Every tick, after the rain's own motion: the emitter's rain past the active camera.
void simulate_layered(Registry&, double time_s);
// Fills frame.rain->layered, after extract_rainfall. interpolation: where the frame stands between the last two ticks.
void extract_layered(const Registry&, Frame&, double time_s, double interpolation);

// The same from plain values, for bare stages: steady wind and camera from time 0 on. Needs frame.rain.
FrameLayered make_frame_layered(const LayeredComposite&, const Frame&, double time_s);

// Velocity of the drawn rain, by the variance that its drops make (n D^4), as the artist bends it; m/s in the world.
glm::vec3 layered_velocity(const LayeredComposite&, const FrameRain&);

}  // namespace petrichor
