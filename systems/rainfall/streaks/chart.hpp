#pragma once
// Size of the streak table against its error, for ways to read it.

#include "systems/chart.hpp"

namespace petrichor {

// `petrichor chart streaks`. Needs no OpenGL. Truth: drops traced for random views, lamps and moments of the
// oscillation, the lamp five degrees in radius. Error: root mean square of the error of radiance over the mean of the
// true streak's and the sphere's, relative to that of even streaks.
Result<void> chart_streaks(const ChartRun&);

}  // namespace petrichor
