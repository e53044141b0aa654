#include "systems/puddle/water.hpp"

#include <algorithm>

namespace petrichor {
namespace {

constexpr double mps_of_mm_per_hour = 1e-3 / 3600.0;

}  // namespace

HollowShape shape_of(const Puddle& p) {
  const double area = std::max(1e-6, double(p.size_m.x) * double(p.size_m.y) * double(p.area_share));
  return {std::max(1e-3 * double(p.maximum_depth_mm), 1e-6), area, area * double(p.catchment_ratio),
          p.shape == PuddleShape::tub, std::clamp(double(p.mean_depth_share), 1.0 / 3.0, 0.5)};
}

WaterFlow flow_of(const Puddle& p, double rain_mm_per_hour) {
  const double air = rain_mm_per_hour > 0.0 ? 0.0 : double(p.evaporation_mm_per_hour);  // rain comes with damp air
  return {rain_mm_per_hour * mps_of_mm_per_hour, (double(p.drain_mm_per_hour) + air) * mps_of_mm_per_hour};
}

PuddleWater start_puddle(const Puddle& p, double rain_mm_per_hour, double time_s) {
  PuddleWater water{p, rain_mm_per_hour, time_s};
  const HollowShape shape = shape_of(p);
  water.depth_m = p.initial_fill >= 0.0f
                      ? double(p.initial_fill) * shape.depth_m
                      : fill(shape, flow_of(p, rain_mm_per_hour), 0.0, 60.0 * double(p.history_min)).depth_m;
  return water;
}

PuddleWater puddle_at(const PuddleWater& water, double time_s) {
  const double duration_s = std::max(time_s - water.since_s, 0.0) * double(water.settings.time_scale);
  const WaterStep step =
      fill(shape_of(water.settings), flow_of(water.settings, water.rain_mm_per_hour), water.depth_m, duration_s);
  PuddleWater later = water;
  later.since_s = std::max(time_s, water.since_s);
  later.depth_m = step.depth_m;
  later.arrived_m3 += step.arrived_m3;
  later.spilled_m3 += step.spilled_m3;
  later.lost_m3 += step.lost_m3;
  return later;
}

}  // namespace petrichor
