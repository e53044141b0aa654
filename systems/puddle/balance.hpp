#pragma once
// The water of one hollow over time, in closed form (shared physics, section 9):
//
//   dV/dt = R A_catchment - (evaporation + drain) A(h) - spill where h would pass the brim,   A(h) = dV/dh
//
// While rain and losses stay the same, depth and spill are exact whatever the step: no integration, so a step of an
// hour gives what 216,000 steps of 1/60 s give. Two shapes: upright sides, and bowls whose wet area grows with the
// depth as A = A_full (a x + b x^2), x = h / H, a + b = 1. Of a bowl of mean depth m H when full a = 6 m - 2, b = 3 - 6
// m: m = 1/2 is a paraboloid, 1/3 a cone; hollows of streets have 0.3 to 0.45.

namespace petrichor {

struct HollowShape {
  double depth_m = 0.01;      // of the brim above the deepest place
  double area_m2 = 1.0;       // wet area when full
  double catchment_m2 = 1.0;  // area whose rain arrives
  bool upright = false;       // else a bowl
  double mean_share = 0.4;    // m, 1/3 to 1/2
};

struct WaterFlow {
  double rain_mps = 0.0;
  double loss_mps = 0.0;  // through the bottom and to the air, from the wet area
};

struct WaterStep {
  double depth_m = 0.0;     // at the end of the step
  double arrived_m3 = 0.0;  // during it
  double spilled_m3 = 0.0;
  double lost_m3 = 0.0;  // drained and evaporated; in an empty tub also what the bottom takes at once
};

double volume_m3(const HollowShape&, double depth_m);
double wet_area_m2(const HollowShape&, double depth_m);

// depth_m from 0 to the hollow's; duration_s >= 0.
WaterStep fill(const HollowShape&, const WaterFlow&, double depth_m, double duration_s);

// Evaporation from water as warm as the air: h_m (rho_s - RH rho_s) / rho_w with the mass transfer coefficient h_m = 7
// mm/s of a light wind. 12 C and 60 %: 0.1 mm/h; 25 C and 50 %: 0.3 mm/h.
double evaporation_mm_per_hour(double temperature_c, double relative_humidity);

}  // namespace petrichor
