// From the history of the water to what a frame's passes need.

#include <algorithm>
#include <cmath>

#include "systems/drip_frame.hpp"
#include "systems/first_of.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/frustum.hpp"
#include "systems/puddle_frame.hpp"
#include "systems/ripple/coverage.hpp"
#include "systems/ripple/history.hpp"
#include "systems/ripple/ripple.hpp"
#include "systems/ripple/waves.hpp"
#include "systems/ripple_frame.hpp"

namespace petrichor {

// Water farther than this shows no rings: they are far below a pixel.
constexpr float farthest_ring_m = 60.0f;

double water_coverage(const Frame& frame) {
  if (!frame.puddles) return 0.0;
  const FrameCamera& camera = frame.camera;
  const float aspect = static_cast<float>(frame.width) / static_cast<float>(std::max(frame.height, 1));
  const Frustum view =
      frustum_of(view_projection_of(camera.orientation, camera.vertical_fov_rad, aspect, camera.near_m));
  const double picture = 4.0 * aspect * std::pow(std::tan(0.5 * camera.vertical_fov_rad), 2);  // at distance 1
  double sum = 0.0;
  for (const FramePuddles::Puddle& p : frame.puddles->puddles) {
    if (!(p.level_m > 0.0f)) continue;
    const glm::vec3 middle(glm::dvec3(p.world_from_puddle[3]) - camera.position_m);
    const glm::mat3 turn(p.world_from_puddle);
    const glm::vec3 half = glm::abs(turn[0]) * p.half_size_m.x + glm::abs(turn[2]) * p.half_size_m.y;
    const float radius = glm::length(p.half_size_m), away = glm::length(middle);
    if (away - radius > farthest_ring_m || !box_touches(view, middle, half)) continue;
    // Its solid angle, seen aslant; near ones fill what they can.
    const double reach = std::max<double>(away, 0.5 * radius);
    const double slant = std::max<double>(std::abs(middle.y) / reach, 0.02);
    sum += std::min(4.0 * p.half_size_m.x * p.half_size_m.y * slant / (reach * reach * picture), 0.6);
  }
  return std::min(sum, 1.0);
}

void extract_ripples(const Registry& registry, Frame& frame, double time_s) {
  frame.ripples.reset();
  if (!frame.puddles || frame.puddles->puddles.empty()) return;
  const auto emitter = first_of<Emitter>(registry);
  const RippleHistory* h = emitter ? registry.find<RippleHistory>(emitter.entity) : nullptr;
  if (!h || (h->newest.ticks.empty() && h->full.empty())) return;
  auto ripples = std::make_shared<FrameRipples>();
  ripples->time_s = time_s;
  ripples->step_s = h->step_s;
  // A hair's breadth after a tick is that tick.
  ripples->tick = std::min(static_cast<std::int64_t>(std::ceil(time_s / h->step_s - 1e-3)), h->next_tick - 1);
  ripples->history = h->identity;
  ripples->settings = h->settings;
  ripples->chunks.assign(h->full.begin(), h->full.end());
  if (!h->newest.ticks.empty()) ripples->chunks.push_back(std::make_shared<const RippleChunk>(h->newest));
  ripples->seen = water_coverage(frame) > 0.0;
  if (frame.drips)
    for (const DripLanding& d : frame.drips->landings) {
      const double age = time_s - d.time_s;
      if (age < 0.0 || age >= landing_memory_s) continue;
      // It is forgotten after a second: it fades before.
      const double fade = std::clamp((landing_memory_s - age) / 0.3, 0.0, 1.0);
      const double speed = std::abs(static_cast<double>(d.velocity_mps.y));
      ripples->drips.push_back({{d.place_m.x, d.place_m.z},
                                static_cast<float>(age),
                                static_cast<float>(seed_amplitude_m(d.diameter_mm, speed, natural_seed_m) * fade)});
    }
  // Nothing falls, nothing moves and what there was has died.
  const RippleTick* newest = ripples->at(ripples->tick);
  const bool waked =
      static_cast<double>(ripples->tick - h->last_wake) * h->step_s < ripple_epoch_s + ripple_memory_s;
  const bool calm =
      newest && !newest->rain && newest->slope_variance < 1e-9f && ripples->drips.empty() && !waked;
  if (!calm) frame.ripples = std::move(ripples);
}

}  // namespace petrichor
