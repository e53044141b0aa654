#pragma once
// Milliseconds against error of the ways to draw falling rain. Needs a current OpenGL context.

#include "systems/chart.hpp"

namespace petrichor {

// Draws rain at 10 mm/h before an even wall and three lamps by fog alone and by the drop field at several distances
// and budgets, and compares each with the truth: every drop to the wall, the mean of 64 instants of the
// exposure. Rain is random, so pictures are compared by their mean and their standard deviation over time, with the
// same drops where a technique draws drops; the floor is what two truths of other seeds differ by. Writes
// rainfall.csv, and with gnuplot rainfall.svg and rainfall.png. `device` is for the title. progress gets 0 to 1.
Result<void> chart_rainfall(const ChartRun&);

}  // namespace petrichor
