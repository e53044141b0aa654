#pragma once
// What happens to the water, tick by tick: kept on the processor, so that the waves on the GPU are a function of it
// alone and not of which frames were drawn.

#include <cstdint>
#include <deque>
#include <limits>

#include "components/water.hpp"
#include "components/weather.hpp"
#include "engine/ecs/registry.hpp"
#include "systems/ripple_frame.hpp"
#include "systems/wind_motion.hpp"

namespace petrichor {

// The waves at a time are those of a simulation that began from rest this long before the newest whole multiple of
// ripple_epoch_s: what is older has died to exp(-1.5 s x decay), 7% of a wave and 0.5% of the slopes' variance. So a
// frame that is drawn alone makes up at most ripple_epoch_s + ripple_memory_s of ticks (480), and one that follows
// another only what lies between them; the waves of the next epoch are made beside it a few ticks a frame (three fifths
// more work).
constexpr double ripple_epoch_s = 2.5, ripple_memory_s = 1.5;

// The first tick of the run that gives the waves at `tick`, 0 or later; of the near tile too, which also begins anew
// where it was set down anew at tick `since`.
std::int64_t run_start(std::int64_t tick, std::int64_t since, double step_s);

struct WaderPlace {
  std::uint32_t entity;
  glm::dvec3 place_m;
};

// On the emitter's entity. Written by simulate_ripples only.
struct RippleHistory {
  std::uint64_t identity = 0;
  Emitter solved;  // what rain and motion belong to
  RippleSettings settings;
  double step_s = 0.0;
  std::shared_ptr<const RippleRain> rain;
  WindMotion motion;
  std::int64_t next_tick = -1;
  float slope_variance = 0.0f;
  std::vector<WaderPlace> waders;  // at the last tick
  std::int64_t last_wake = std::numeric_limits<std::int64_t>::min() / 2;  // tick
  std::deque<std::shared_ptr<const RippleChunk>> full;
  RippleChunk newest;
};

// The rain as rings see it. Classes under this diameter make none that could be seen (amplitude goes with D^2.6).
constexpr float smallest_ring_mm = 0.9f;
std::shared_ptr<const RippleRain> make_ripple_rain(const Emitter&, const RippleSettings&);

RippleSettings ripple_settings(const Registry&);

}  // namespace petrichor
