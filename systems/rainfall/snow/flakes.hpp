#pragma once
// Snow flakes: how large, how heavy, how fast, how many at a given rate of snowfall, and the split into classes that
// fall as one. Sizes are largest dimensions, mm (shared physics, section 12).

#include <array>
#include <vector>

namespace petrichor {

// Smaller ones are single crystals, larger ones rare: neither carries much of the water.
constexpr double smallest_flake_mm = 0.5, largest_flake_mm = 20.0;

// Unrimed aggregates: 0.073 D^1.4 mg fall at 0.8 D^0.16 m/s on average.
double flake_mass_mg(double diameter_mm);
double flake_speed_mps(double diameter_mm);
// Of flakes of one size (Barthazy and Schefold 2006 find 0.3 to 0.7 m/s).
constexpr double flake_speed_deviation_mps = 0.3;
// What an aggregate covers of the view, mm2; mean over its orientations. Mitchell 1996, aggregates: 0.2285 D^1.88 (cm):
// an open web that fills a third of its circle.
double flake_area_mm2(double diameter_mm);
// Diameters of the drop that a flake melts to.
double melted_mm(double diameter_mm);
double diameter_of_melted_mm(double melted_mm);

// Gunn and Marshall 1958: N(x) = n0 exp(-slope x) in 1/(m3 mm) of melted diameters x, n0 = 3800 R^-0.87. Their slope is
// 2.55 R^-0.48; here it is solved so that the water which falls is the water that was asked for, exactly. Where even
// a slope of 0 carries too little (above some 5 mm/h), n0 grows.
struct FlakeSizeDistribution {
  double n0 = 0.0, slope_per_mm = 1.0;
};
FlakeSizeDistribution solve_flake_sizes(double snow_mm_per_hour);  // >= 0; at 0 n0 is 0
double density(const FlakeSizeDistribution&, double melted_mm);    // 0 outside the flakes' sizes

// A range of sizes at one of three speeds.
struct FlakeClass {
  double from_mm, to_mm;
  double fall_speed_mps;  // independent of the rate: a change would shift the whole field
  double diameter_mm;     // such that mass, speed and number give the class's water exactly
  double area_mm2;        // such that area and number give the class's extinction exactly
  double flakes_per_m3;
  double base_flakes_per_m3;  // density of the field's first layer: depends on the class alone
};
constexpr int flake_size_classes = 10;
// Of a normal distribution of speeds, as three that share its first five moments (Gauss and Hermite): deviations from
// the mean in units of flake_speed_deviation_mps, and shares of the flakes.
constexpr std::array<double, 3> speed_offset{-1.7320508075688772, 0.0, 1.7320508075688772};
constexpr std::array<double, 3> speed_share{1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0};

std::vector<FlakeClass> make_flake_classes(double snow_mm_per_hour);  // by rising size
double snow_mm_per_hour(const FlakeClass&);                           // water reaching level ground
double extinction_per_m(const FlakeClass&);                           // geometric

}  // namespace petrichor
