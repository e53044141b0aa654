#pragma once
// The state that the water of a Puddle has, beside what the component says; and where it is at a time.

#include "components/water.hpp"
#include "systems/puddle/balance.hpp"

namespace petrichor {

// What is true since a moment: constant rain and settings. The depth later follows in closed form.
struct PuddleWater {
  Puddle settings;
  double rain_mm_per_hour = 0.0;
  double since_s = 0.0;
  double depth_m = 0.0;  // at that moment, as are the sums
  double arrived_m3 = 0.0, spilled_m3 = 0.0, lost_m3 = 0.0;
};

HollowShape shape_of(const Puddle&);
WaterFlow flow_of(const Puddle&, double rain_mm_per_hour);

// A puddle as it is when the scene begins (Puddle::initial_fill).
PuddleWater start_puddle(const Puddle&, double rain_mm_per_hour, double time_s);
// The same water told from a later moment on.
PuddleWater puddle_at(const PuddleWater&, double time_s);

}  // namespace petrichor
