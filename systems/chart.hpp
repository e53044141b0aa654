#pragma once
// Speed against accuracy as a table and a picture: what `petrichor chart` writes for every ladder.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace petrichor {

// One rung at one setting.
struct ChartPoint {
  std::string rung;                            // of the ladder
  std::string label;                           // beside the mark: the setting ("30 k drops", "as published")
  double ms = 0.0, ms_p5 = 0.0, ms_p95 = 0.0;  // median of the frames timed; the bar
  double error = 0.0;                          // the effect left out: 1
  double mean_shift = 0.0;  // of the time-mean picture, as a share of the background; 0 where that means nothing
  bool stable = true;       // false: fails a test of tests/stability or moves the mean: a hollow mark
  std::vector<std::pair<std::string, double>> more;  // further columns, the same for all points of a chart
};

struct Chart {
  std::string name;    // of the files: "rainfall-night"
  std::string effect;  // of the ladder: "rainfall"
  std::string title;   // "Falling rain, 10 mm/h, night lamps"
  std::string device;
  int width = 0, height = 0;
  std::string x_label = "milliseconds (median; bar 5% to 95%)";
  std::string error_label = "error (the effect left out: 1)";
  double floor = 0.0;  // error of two truths of other seeds; 0: none, the truth is not random
  std::vector<ChartPoint> points;
};

// Stable points than which no other stable one is both faster and truer. One flag a point.
std::vector<bool> on_hull(const std::vector<ChartPoint>&);

// NAME.csv, and with gnuplot NAME.svg and NAME.png. Without gnuplot it warns and writes the table alone.
Result<void> write_chart(const std::filesystem::path& folder, const Chart&);
// The table that write_chart wrote; errors name file and line.
Result<Chart> read_chart(const std::filesystem::path& csv);
// Draws every table of a folder again, say those of a machine without gnuplot.
Result<void> redraw_charts(const std::filesystem::path& folder);

// What a chart is made with. progress gets 0 to 1; software: timings by glFinish, smaller pictures.
struct ChartRun {
  std::filesystem::path folder;
  std::string device;
  bool software = true;
  std::function<void(double)> progress;
};

// A chart that can be asked for by name. systems.cpp lists them.
struct ChartOffer {
  std::string_view name;
  std::string_view meaning;
  std::function<Result<void>(const ChartRun&)> run;
};
std::vector<ChartOffer> all_charts();

}  // namespace petrichor
