#pragma once
// The chart of `petrichor chart classes`: how many size classes of drops are enough.

#include "systems/chart.hpp"

namespace petrichor {

// The same rain in 1 to 32 drawn classes against 64: what a finite number of fall speeds and diameters does to the
// spread of streak lengths and tilts, to kinetic energy, extinction and impacts, and to the picture; against the time
// to draw it. Writes classes.csv and its picture.
Result<void> chart_classes(const ChartRun&);

}  // namespace petrichor
