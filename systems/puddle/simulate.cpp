// Each tick: has the rain or a puddle's setting changed? Then its water is told anew from there. Else nothing is done.

#include <vector>

#include "components/weather.hpp"
#include "systems/first_of.hpp"
#include "systems/puddle/puddle.hpp"
#include "systems/puddle/water.hpp"

namespace petrichor {
namespace {

bool same_balance(const Puddle& a, const Puddle& b) {
  return a.size_m == b.size_m && a.maximum_depth_mm == b.maximum_depth_mm && a.area_share == b.area_share &&
         a.catchment_ratio == b.catchment_ratio && a.shape == b.shape && a.mean_depth_share == b.mean_depth_share &&
         a.drain_mm_per_hour == b.drain_mm_per_hour && a.evaporation_mm_per_hour == b.evaporation_mm_per_hour &&
         a.time_scale == b.time_scale;
}

bool same_start(const Puddle& a, const Puddle& b) {
  return a.initial_fill == b.initial_fill && a.history_min == b.history_min;
}

}  // namespace

void simulate_puddles(Registry& registry, double time_s, double step_s) {
  const auto emitter = first_of<Emitter>(registry);
  const double rain = emitter ? double(emitter->rain_mm_per_hour) : 0.0;
  std::vector<Entity> fresh;
  registry.view<const Puddle>().each([&](Entity entity, const Puddle& p) {
    PuddleWater* water = registry.find<PuddleWater>(entity);
    if (!water || !same_start(water->settings, p)) {
      fresh.push_back(entity);
      return;
    }
    const bool same = same_balance(water->settings, p);
    if (same && water->rain_mm_per_hour == rain) return;
    // What is found at a tick holds from the tick before.
    *water = puddle_at(*water, time_s - step_s);
    const double share = water->depth_m / shape_of(water->settings).depth_m;
    if (!same) water->depth_m = share * shape_of(p).depth_m;  // a hollow of another depth: as full as it was
    water->settings = p;
    water->rain_mm_per_hour = rain;
  });
  for (const Entity entity : fresh)
    registry.emplace_or_replace<PuddleWater>(entity, start_puddle(registry.get<Puddle>(entity), rain, time_s - step_s));
}

}  // namespace petrichor
