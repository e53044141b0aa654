#pragma once
// The falling snow of one frame. Filled by systems/rainfall/snow.

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "systems/rain_frame.hpp"

namespace petrichor {

// Flakes of one size that fall equally fast: one rigid falling frame, in which each flake sways by itself
// (systems/rainfall/snow/flake.glsl).
struct SnowClass {
  float diameter_mm;  // largest dimension of the flake
  float area_mm2;     // its projected area, the mean over its tumbling: what dims the view
  float fall_speed_mps;
  float flakes_per_m3;       // now
  float base_flakes_per_m3;  // density of the field's first layer; each further layer doubles what is there
  float reach = 1.0f;        // share of FrameSnow::drawn_distance_m out to which it is drawn singly
  glm::dvec3 origin_m;       // the class's frame, in the world, at the frame's time (when the shutter closes)
  glm::vec3 velocity_mps;    // wind of this class minus fall
};

constexpr int snow_onsets = 6;         // five groups of classes, and the cone
constexpr double snow_clock_s = 64.0;  // flakes sway at multiples of 1 / 64 Hz, so their clock wraps without a jump

struct FrameSnow {
  float snow_mm_per_hour = 0.0f;  // of water
  std::uint32_t seed = 1;
  float asked_distance_m = 0.0f;  // as the component says
  std::int32_t maximum_flakes = 0;
  float sway = 1.0f;     // multiplies the radius
  float clock_s = 0.0f;  // of the sway: time modulo snow_clock_s
  // After the budget: single flakes turn transparent from fade_start_m to drawn_distance_m, times their class's reach.
  float fade_start_m = 0.0f;
  float drawn_distance_m = 0.0f;
  float expected_flakes = 0.0f;       // single flakes in the view, on average
  float extinction_per_m = 0.0f;      // geometric, of all flakes; all classes are drawn
  glm::vec3 mean_velocity_mps{0.0f};  // mass-weighted: the direction of the occlusion map where it does not rain
  std::vector<SnowClass> classes;
  Techniques techniques;       // of the frame; see share()
  float cone_jitter_m = 0.0f;  // how far pass snow_cone's textures sway
  FrameCone cone;              // of pass snow_cone; far_m is where its snow ends and haze begins
  float share(SnowRung rung) const { return techniques.share(Effect::snow, rung); }
  // Out to where each technique draws; update_onsets fills them. With the haze's own they sum to extinction_per_m.
  float fog_extinction_per_m = 0.0f;
  std::array<RainOnset, snow_onsets> onsets{};
};

// As of the rain (rain_frame.hpp): the haze that stands in for flakes which nobody draws singly. The fade is linear, so
// extinction that starts in its middle has the same mean transmittance beyond it.
inline void update_onsets(FrameSnow& s) {
  s.onsets = {};
  constexpr int field_onsets = snow_onsets - 1;
  const float middle = 0.5f * (s.fade_start_m + s.drawn_distance_m), field = s.share(SnowRung::field);
  float all = 0.0f, before = 0.0f;
  for (const SnowClass& c : s.classes) all += c.flakes_per_m3 * c.area_mm2;
  for (const SnowClass& c : s.classes) {
    if (!(all > 0.0f)) break;
    const float share = c.flakes_per_m3 * c.area_mm2 / all, extinction = share * field * s.extinction_per_m;
    RainOnset& o = s.onsets[std::min(int((before + 0.5f * share) * field_onsets), field_onsets - 1)];
    const float sum = o.extinction_per_m + extinction;
    if (sum > 0.0f) o.onset_m = (o.onset_m * o.extinction_per_m + middle * c.reach * extinction) / sum;
    o.extinction_per_m = sum;
    before += share;
  }
  if (!(all > 0.0f)) s.onsets[0] = {field * s.extinction_per_m, middle};
  s.onsets[field_onsets] = {s.share(SnowRung::double_cone) * s.extinction_per_m, s.cone.far_m};
  float sum = 0.0f;
  for (const RainOnset& o : s.onsets) sum += o.extinction_per_m;
  s.fog_extinction_per_m = std::max(s.extinction_per_m - sum, 0.0f);
}

}  // namespace petrichor
