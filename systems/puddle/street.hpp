#pragma once
// The truth of puddles: a patch of street as a fine height field whose hollows fill, spill into each other and dry by
// what the ground really is, in double precision.

#include <vector>

#include "systems/puddle/balance.hpp"

namespace petrichor {

struct StreetHollow {
  double brim_m = 0.0, deepest_m = 0.0;
  double catchment_m2 = 0.0;       // what runs into it before any other
  int spills_into = -1;            // -1: off the patch
  std::vector<std::size_t> cells;  // from the deepest up
  std::vector<double> heights_m;   // of these
};

struct StreetPatch {
  int width = 0, height = 0;
  double cell_m = 0.025;
  std::vector<double> ground_m;
  std::vector<int> hollow_of;         // -1: none
  std::vector<StreetHollow> hollows;  // by place of the flood: what spills does so into one of a smaller number
};

// 8 x 6 m with two ruts and a few settled places; water leaves at the patch's edge.
StreetPatch make_street_patch();

struct ShowerPart {
  double minutes, rain_mm_per_hour;
};

// Steps of step_s, explicit: at 0.5 s, levels are exact to 1 um. One level for each hollow at each time asked for.
class StreetTruth {
 public:
  explicit StreetTruth(const StreetPatch&);
  void advance(double duration_s, double step_s, double rain_mps, double loss_mps);
  double level_m(std::size_t hollow) const { return levels_[hollow]; }  // world
  double stored_m3() const;
  double arrived_m3 = 0.0, left_m3 = 0.0, lost_m3 = 0.0;

 private:
  void find_level(std::size_t hollow);
  const StreetPatch& patch_;
  std::vector<double> volumes_, levels_;
  std::vector<std::vector<double>> below_;  // volume of a hollow up to each of its cells
};

}  // namespace petrichor
