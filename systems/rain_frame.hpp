#pragma once
// The falling rain of one frame, as the passes need it. Filled by systems/rainfall.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

// One size class of the drop field (design section 4): it falls as one rigid frame.
struct RainClass {
  float diameter_mm;
  float fall_speed_mps;
  float drops_per_m3;       // now
  float base_drops_per_m3;  // density of the field's first layer; each further layer doubles what is there
  float reach = 1.0f;       // share of FrameRain::drawn_distance_m out to which it is drawn singly
  bool drawn;               // false: too small to be drawn singly, but it falls and is measured
  glm::dvec3 origin_m;      // the class's frame, in the world, at the frame's time (when the shutter closes)
  glm::vec3 velocity_mps;   // wind of this class minus fall
};

struct FrameRain {
  float rain_mm_per_hour = 0.0f;
  std::uint32_t seed = 1;
  float asked_distance_m = 0.0f;  // as the emitter says
  std::int32_t maximum_drops = 0;
  // After the budget of drops: single drops fade out (one by one) from fade_start_m to drawn_distance_m.
  float fade_start_m = 0.0f;
  float drawn_distance_m = 0.0f;
  float mean_reach = 1.0f;              // of the drawn classes, weighted by extinction
  float expected_drops = 0.0f;          // single drops in the view, on average
  float extinction_per_m = 0.0f;        // geometric, of all drops (Q = 1)
  float drawn_extinction_per_m = 0.0f;  // of the classes that are drawn
  glm::vec3 mean_velocity_mps{0.0f};    // mass-weighted: the direction of the occlusion map
  std::vector<RainClass> classes;
};

// FrameUniforms::rain of this rain: what fog has to stand in for. The fade is linear, so extinction that
// starts in its middle has the same mean transmittance beyond it; likewise for classes of different reach.
inline glm::vec4 rain_uniform(const FrameRain& r) {
  return {r.drawn_extinction_per_m, 0.5f * (r.fade_start_m + r.drawn_distance_m) * r.mean_reach,
          r.extinction_per_m - r.drawn_extinction_per_m, r.rain_mm_per_hour};
}

}  // namespace petrichor
