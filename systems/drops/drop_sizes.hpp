#pragma once
// How many drops of each size fall at a given rain rate, and the split into classes that fall as one.

#include <vector>

#include "components/weather.hpp"

namespace petrichor {

// N(D) = n0 D^shape exp(-slope D), in 1/(m3 mm), D in mm, for smallest_drop_mm <= D <= maximum_mm.
// Marshall-Palmer (shape 0): n0 = 8000, and the slope is solved so that the water which falls is the water
// that was asked for, exactly (their own 4.1 R^-0.21 falls up to 18% too much; the root lies within 1% of
// 4.25 R^-0.215). Gamma (Ulbrich 1983): the median-volume diameter of Marshall-Palmer at that rate,
// slope D0 = 3.67 + shape, and n0 solved from the rate: the shape alone changes.
struct DropSizeDistribution {
  double n0 = 0.0;
  double shape = 0.0;
  double slope_per_mm = 1.0;
  double minimum_mm = 0.1;
  double maximum_mm = 6.0;
};

// Smaller drops than this carry under 0.1% of the water of any rain and are left out altogether.
constexpr double smallest_drop_mm = 0.1;

// rain_mm_per_hour >= 0; at 0 n0 is 0.
DropSizeDistribution solve_distribution(DropSizes, double gamma_shape, double maximum_mm, double rain_mm_per_hour);
double density(const DropSizeDistribution&, double diameter_mm);  // 1/(m3 mm); 0 outside the range

// Integral of N(D) D^power v(D)^speed_power over [from, to], mm; speed in m/s.
double moment(const DropSizeDistribution&, double power, double speed_power, double from_mm, double to_mm);

// A range of diameters that falls as one rigid frame.
struct DropClass {
  double from_mm, to_mm;
  // Speed at the middle of the range. It must not depend on the rain rate: the class has fallen V t by now,
  // and a change of V would shift the whole field.
  double fall_speed_mps;
  double diameter_mm;        // such that diameter, speed and number give the class's water exactly
  double drops_per_m3;       // exact integral
  double base_drops_per_m3;  // density of the first layer of the field: depends on the sizes, not on the rate
  bool drawn;                // at least minimum_diameter_mm
};

constexpr int drawn_classes = 16;   // between minimum_diameter_mm and maximum_diameter_mm, log-spaced
constexpr int undrawn_classes = 6;  // below it, down to smallest_drop_mm: they fall, are counted and dim the view

// The small undrawn classes first, then the drawn ones, by rising diameter.
// `drawn`: how many of those; the chart `classes` says what fewer cost in truth and more in time.
std::vector<DropClass> make_drop_classes(const Emitter&, int drawn = drawn_classes);

double rain_mm_per_hour(const DropClass&);  // water reaching level ground
double extinction_per_m(const DropClass&);  // geometric (Q = 1), of the class as it is drawn

}  // namespace petrichor
