#pragma once
// A ladder: the ways to draw one effect, cheapest first, each with what it costs and how wrong it is, so that charts
// can show them and the director can choose (design, section 6).

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "systems/techniques.hpp"

namespace petrichor {

struct Frame;

struct Rung {
  std::string_view name;     // "double_cone", for --technique rainfall=double_cone
  std::string_view meaning;  // one line
  // The passes whose times are its cost, by the names that they have in the frame's timings.
  std::vector<std::string_view> passes;
  // Before anything has been measured on this machine: of the chart (content/ladders.csv has newer ones), at 640x360.
  double chart_ms = 0.0;
  double chart_error = 0.0;  // the effect left out: 1; the truth: 0
  bool stable = true;        // false: fails a test of tests/stability/, so the director leaves it alone
};

struct Ladder {
  Effect effect;
  std::string_view name;           // "rainfall"
  std::string_view meaning;        // what is drawn
  std::string_view truth;          // what the rungs are compared with
  std::string_view error_measure;  // how
  std::vector<Rung> rungs;
  // What the error of its rungs weighs in this frame, 0 to 1: about how much of the picture the effect can change. Rain
  // and snow go by their rate, on a scale that is a guess; 0 is exact: it is not there, and costs nothing.
  std::function<double(const Frame&)> coverage;
  // False: the director leaves it as it is (it is no question of speed, or a change of it shows).
  bool directed = true;
  // False: one rung cannot be drawn over another, so a change is seen at once rather than cross-faded.
  bool fades = true;
};

// One for each Effect, in its order. systems/systems.cpp
std::vector<Ladder> all_ladders();

}  // namespace petrichor
