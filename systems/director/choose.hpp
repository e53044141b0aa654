#pragma once
// The search: which rungs together leave the least visible error within a limit. A multiple-choice knapsack, solved
// exactly: there are millions of combinations, but few that nothing beats in time and error both.

#include <array>
#include <vector>

#include "systems/director/costs.hpp"

namespace petrichor {

using Rungs = std::array<int, effect_count>;

struct Question {
  const std::vector<Ladder>* ladders = nullptr;
  const CostTable* table = nullptr;
  std::array<double, effect_count> coverage{};
  Rungs now{};
  std::array<std::vector<char>, effect_count> allowed;  // by rung; `now` always is
  double spread = 1.0;                                  // p95 over median
  double limit_ms = 0.0;                                // of the p95
  double trade_penalty = 0.0;  // of visible error, for each effect that gets worse so that another gets better
};

struct Answer {
  Rungs rungs{};
  double ms = 0.0;     // the median frame that is expected
  double error = 0.0;  // visible: error x coverage, summed
  bool fits = false;   // false: nothing does, and this is the cheapest
};

double expected_ms(const Question&, const Rungs&);
double visible_error(const Question&, const Rungs&);
Answer choose(const Question&);

}  // namespace petrichor
