#include "systems/director/choose.hpp"

#include <limits>

namespace petrichor {
namespace {

constexpr std::size_t resolution_effect = static_cast<std::size_t>(Effect::resolution);
constexpr double change_penalty = 0.002;  // of visible error: of equals the one that changes less
constexpr double least_saving = 0.02;     // of a frame: for less nothing is changed where nothing fits anyway

bool next(const Question& question, Rungs& rungs) {
  for (std::size_t e = 0; e < effect_count; ++e) {
    const auto& allowed = question.allowed[e];
    for (++rungs[e]; rungs[e] < static_cast<int>(allowed.size()); ++rungs[e])
      if (allowed[static_cast<std::size_t>(rungs[e])]) return true;
    for (rungs[e] = 0; rungs[e] < static_cast<int>(allowed.size()) && !allowed[static_cast<std::size_t>(rungs[e])];)
      ++rungs[e];
  }
  return false;
}

}  // namespace

double expected_ms(const Question& question, const Rungs& rungs) {
  const auto size = static_cast<std::size_t>(rungs[resolution_effect]);
  double ms = 0.0;
  for (std::size_t e = 0; e < effect_count; ++e)
    if (const auto& rows = question.table->ms[e]; !rows.empty()) ms += rows[static_cast<std::size_t>(rungs[e])][size];
  return ms;
}

double visible_error(const Question& question, const Rungs& rungs) {
  double error = 0.0;
  for (const Ladder& ladder : *question.ladders) {
    const auto e = static_cast<std::size_t>(ladder.effect);
    if (ladder.directed) error += ladder.rungs[static_cast<std::size_t>(rungs[e])].chart_error * question.coverage[e];
  }
  return error;
}

Answer choose(const Question& question) {
  Rungs rungs{};
  for (std::size_t e = 0; e < effect_count; ++e)
    while (!question.allowed[e][static_cast<std::size_t>(rungs[e])]) ++rungs[e];
  Answer best, cheapest;
  double best_value = std::numeric_limits<double>::infinity();
  double cheapest_ms = best_value;
  const double limit_ms = question.limit_ms;
  const double saving_ms = least_saving * expected_ms(question, question.now);
  do {
    const double ms = expected_ms(question, rungs);
    int changes = 0, worse = 0;
    double charted_ms = 0.0;  // of equals the one that is cheaper on the chart: measured figures are not so even
    for (std::size_t e = 0; e < effect_count; ++e) {
      const auto& ladder = (*question.ladders)[e].rungs;
      charted_ms += ladder[static_cast<std::size_t>(rungs[e])].chart_ms;
      if (rungs[e] == question.now[e]) continue;
      ++changes;
      worse += ladder[static_cast<std::size_t>(rungs[e])].chart_error >
               ladder[static_cast<std::size_t>(question.now[e])].chart_error;
    }
    const double error = visible_error(question, rungs);
    const double handicapped_ms = ms + saving_ms * changes + 1e-6 * error;
    if (handicapped_ms < cheapest_ms) {
      cheapest_ms = handicapped_ms;
      cheapest = {rungs, ms, error, false};
    }
    if (ms * question.spread > limit_ms) continue;
    const double value =
        error + change_penalty * changes + question.trade_penalty * worse + (1e-5 * charted_ms + 1e-6 * ms) / limit_ms;
    if (value < best_value) {
      best_value = value;
      best = {rungs, ms, error, true};
    }
  } while (next(question, rungs));
  return best.fits ? best : cheapest;
}

}  // namespace petrichor
