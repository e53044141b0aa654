#pragma once
// The falling rain of one frame, as the passes need it. Filled by systems/rainfall.

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "systems/cone_frame.hpp"
#include "systems/layered_frame.hpp"
#include "systems/techniques.hpp"

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

// What one technique draws of the rain, for the fog to stand in for the rest: extinction per metre that it draws from
// the camera out to onset_m, beyond which fog takes over.
struct RainOnset {
  float extinction_per_m = 0.0f;
  float onset_m = 0.0f;
};
constexpr int rain_onsets = 8;

// Streak sprites (Tariq 2007). Filled by systems/rainfall/sprites.
struct FrameSprites {
  bool published = false, frozen = false;
  bool hidden = false, hide_background = false, simple_shader = false;
  float fraction = 1.0f, directional_response = 1.0f, lamp_response = 1.0f;
  float wind = 1.0f;    // multiplies the wind
  float box_m = 20.0f;  // edge of the box about the camera that holds the drops; drawn is the sphere in it
  std::int32_t count = 0;
  std::vector<glm::dvec3> offset_m;  // by class, added to its origin: what freezing and other wind made of it; or empty
  // Single drops fade out, one by one, from fade_start_m to far_m.
  float far_m() const { return 0.5f * box_m; }
  float fade_start_m() const { return 0.9f * far_m(); }
  float onset_m() const { return 0.5f * (fade_start_m() + far_m()); }
  float drawn_share() const { return hidden ? 0.0f : fraction; }
};

// Near drops (Rana). Filled by systems/rainfall/near_drops; NearDrops of components/techniques.hpp says what is what.
struct FrameNearDrops {
  bool published = false;
  float least_width_px = 1.0f;
  std::int32_t most_drops = 4096;
  float step_m = 1.0f;
  std::int32_t map_cells = 20, map_pixels = 16;
  bool parallax = true;  // the surroundings are where they are, not at infinity
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
  Techniques techniques;  // of the frame; see share()
  FrameCone cone;
  FrameLayered layered;
  FrameSprites sprites;
  FrameNearDrops near_drops;
  // Share of all drops that each technique draws; every technique thins its drops to it, so that while two give way to
  // one another the mean stays. The rungs of the field share one field.
  float share(RainRung rung) const { return techniques.share(Effect::rainfall, rung); }
  float field_share() const {
    return share(RainRung::drop_field) + share(RainRung::full_field) + share(RainRung::near_drops);
  }
  // Out to where each technique draws; update_onsets fills them. With the fog's own they sum to
  // drawn_extinction_per_m.
  float fog_extinction_per_m = 0.0f;
  std::array<RainOnset, rain_onsets> onsets{};
};

// FrameUniforms::rain of this rain: means, for airlight. Transmittance is exact by FrameUniforms::rain_onsets.
inline glm::vec4 rain_uniform(const FrameRain& r) {
  float sum = 0.0f, reach = 0.0f;
  for (const RainOnset& o : r.onsets) sum += o.extinction_per_m, reach += o.extinction_per_m * o.onset_m;
  return {sum, sum > 0.0f ? reach / sum : 0.0f, r.extinction_per_m - r.drawn_extinction_per_m + r.fog_extinction_per_m,
          r.rain_mm_per_hour};
}

// Fills onsets from the classes, the distances and the shares; after whoever changes one of them. The field's fade is
// linear, so extinction that starts in its middle has the same mean transmittance beyond it.
inline void update_onsets(FrameRain& r) {
  r.onsets = {};
  constexpr int field_onsets = rain_onsets - 3;
  const float middle = 0.5f * (r.fade_start_m + r.drawn_distance_m), field = r.field_share();
  float drawn = 0.0f;
  for (const RainClass& c : r.classes)
    if (c.drawn) drawn += c.drops_per_m3 * c.diameter_mm * c.diameter_mm;
  // Classes of different reach, a few at a time, by equal shares of the extinction.
  float before = 0.0f;
  for (const RainClass& c : r.classes) {
    if (!c.drawn || !(drawn > 0.0f)) continue;
    const float share = c.drops_per_m3 * c.diameter_mm * c.diameter_mm / drawn;
    RainOnset& o = r.onsets[std::min(int((before + 0.5f * share) * field_onsets), field_onsets - 1)];
    const float extinction = share * field * r.drawn_extinction_per_m;
    const float sum = o.extinction_per_m + extinction;
    if (sum > 0.0f) o.onset_m = (o.onset_m * o.extinction_per_m + middle * c.reach * extinction) / sum;
    o.extinction_per_m = sum;
    before += share;
  }
  // Without classes (tests that say only the sums): all at one distance.
  if (!(drawn > 0.0f)) r.onsets[0] = {field * r.drawn_extinction_per_m, middle * r.mean_reach};
  r.onsets[field_onsets] = {r.share(RainRung::double_cone) * r.drawn_extinction_per_m, r.cone.far_m};
  r.onsets[field_onsets + 1] = {r.share(RainRung::composite) * r.drawn_extinction_per_m, r.layered.far_m};
  r.onsets[field_onsets + 2] = {r.share(RainRung::sprites) * r.drawn_extinction_per_m, r.sprites.onset_m()};
  // Fog alone: from the camera on. It shares an onset of 0 with nothing else, so it is what is missing in the sum.
  float sum = 0.0f;
  for (const RainOnset& o : r.onsets) sum += o.extinction_per_m;
  r.fog_extinction_per_m = std::max(r.drawn_extinction_per_m - sum, 0.0f);
}

}  // namespace petrichor
