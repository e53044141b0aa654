#pragma once
// The ripples of one frame. Filled by systems/ripple: what fell on the water and what moved through it, tick by tick,
// so that the state of the waves can be made from it in whatever order frames are drawn.

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

namespace petrichor {

// The classes of drops that make rings. Replaced when the rate changes.
struct RippleRain {
  struct Class {
    float diameter_mm, fall_speed_mps;
    float drops_per_m3, base_drops_per_m3;
    std::uint32_t field_index;  // among the drop field's classes: the streak, the splash and the ring are one drop
  };
  std::vector<Class> classes;
  std::uint32_t seed = 1;
  // Mean square slope that this rain adds to water in a second, of the shared tile, and of all water beyond it.
  float slope_variance_per_s = 0.0f;
};

// Something moved through the water during a tick.
struct RippleWake {
  glm::dvec2 place_m;  // world x and z, at the tick
  glm::vec2 moved_m;   // during it
  float radius_m, draft_m;
};

struct RippleTick {
  std::shared_ptr<const RippleRain> rain;  // null: it is dry
  std::vector<glm::dvec3> origins_m;       // where each of its classes is by now (world)
  std::vector<RippleWake> wakes;
  // The tile of the world near the eye: its middle, in cells of the world; the tick at which it was last set down
  // anew (a cut); the water's level there.
  glm::ivec2 near_centre{0};
  float near_cell_m = 0.0f;  // 0: there is no eye or no water yet
  std::int64_t near_since = 0;
  float water_m = 0.0f;
  float slope_variance = 0.0f;  // by the balance of rain and decay
};

// A second or so of ticks; full ones are shared between frames.
struct RippleChunk {
  std::int64_t first_tick = 0;
  std::vector<RippleTick> ticks;
};

// A drip's ring.
struct RippleRing {
  glm::dvec2 place_m;
  float age_s;
  float amplitude_m;
};

struct RippleSettings {
  bool published = false;
  float strength = 1.0f;
  float wave_speed_mps = 0.235f;
  float decay_per_s = 1.8f;
  float tile_m = 0.75f;
  float seed_cells = 3.0f;
};

struct FrameRipples {
  double time_s = 0.0;
  double step_s = 1.0 / 120.0;
  std::int64_t tick = -1;     // the newest that is not before time_s
  std::uint64_t history = 0;  // which: another scene, another settings
  bool seen = false;          // standing water is in view
  RippleSettings settings;
  std::vector<std::shared_ptr<const RippleChunk>> chunks;  // by tick, without a gap, as far back as waves live
  std::vector<RippleRing> drips;                           // that have landed near the eye
  std::int64_t first_tick() const { return chunks.empty() ? 0 : chunks.front()->first_tick; }
  const RippleTick* at(std::int64_t wanted) const {
    for (auto c = chunks.rbegin(); c != chunks.rend(); ++c)
      if (wanted >= (*c)->first_tick)
        return wanted < (*c)->first_tick + static_cast<std::int64_t>((*c)->ticks.size())
                   ? &(*c)->ticks[static_cast<std::size_t>(wanted - (*c)->first_tick)]
                   : nullptr;
    return nullptr;
  }
};

}  // namespace petrichor
