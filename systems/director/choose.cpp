#include "systems/director/choose.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace petrichor {
namespace {

constexpr std::size_t resolution_effect = static_cast<std::size_t>(Effect::resolution);
constexpr double change_penalty = 0.002;  // of visible error: of equals the one that changes less
constexpr double least_saving = 0.02;     // of a frame: for less nothing is changed where nothing fits anyway

// A rung of one effect: what it adds to the two figures that are searched over.
struct Option {
  int rung;
  double ms, value;
};

// Rungs of the effects looked at so far, and what they add up to.
struct Partial {
  double ms = 0.0, value = 0.0;
  std::array<std::int8_t, effect_count> rungs{};
};

// Of partial answers, those than which no other is both shorter and better, by rising time. No dearer answer can grow
// from the others, since what is added later is the same for all.
void keep_best(std::vector<Partial>& partials, double longest_ms) {
  std::stable_sort(partials.begin(), partials.end(),
                   [](const Partial& a, const Partial& b) { return a.ms != b.ms ? a.ms < b.ms : a.value < b.value; });
  double least_value = std::numeric_limits<double>::infinity();
  std::erase_if(partials, [&](const Partial& p) {
    if (p.ms > longest_ms || !(p.value < least_value)) return true;
    least_value = p.value;
    return false;
  });
}

// The best answer of those that take at most longest_ms, as a multiple-choice knapsack: exact, effect by effect. False:
// there is none.
bool best_within(const std::array<std::vector<Option>, effect_count>& options, double longest_ms, Partial& best) {
  // What the effects still to come take at least.
  std::array<double, effect_count + 1> least_ms{};
  for (std::size_t e = effect_count; e-- > 0;) {
    double least = std::numeric_limits<double>::infinity();
    for (const Option& option : options[e]) least = std::min(least, option.ms);
    least_ms[e] = least_ms[e + 1] + least;
  }
  std::vector<Partial> partials(1), grown;
  for (std::size_t e = 0; e < effect_count; ++e) {
    grown.clear();
    for (const Partial& p : partials)
      for (const Option& option : options[e]) {
        grown.push_back(p);
        grown.back().ms += option.ms;
        grown.back().value += option.value;
        grown.back().rungs[e] = static_cast<std::int8_t>(option.rung);
      }
    keep_best(grown, longest_ms - least_ms[e + 1]);
    std::swap(partials, grown);
  }
  if (partials.empty()) return false;
  best = partials.back();
  return true;
}

Rungs rungs_of(const Partial& p) {
  Rungs rungs{};
  std::copy(p.rungs.begin(), p.rungs.end(), rungs.begin());
  return rungs;
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
  Answer best, cheapest;
  double best_value = std::numeric_limits<double>::infinity();
  double cheapest_ms = best_value;
  const double saving_ms = least_saving * expected_ms(question, question.now);
  // Times depend on the resolution, all else adds up effect by effect.
  for (std::size_t size = 0; size < question.allowed[resolution_effect].size(); ++size) {
    if (!question.allowed[resolution_effect][size]) continue;
    std::array<std::vector<Option>, effect_count> by_value, by_time;
    for (std::size_t e = 0; e < effect_count; ++e) {
      const Ladder& ladder = (*question.ladders)[e];
      const auto& now = ladder.rungs[static_cast<std::size_t>(question.now[e])];
      const auto& times = question.table->ms[e];
      for (std::size_t r = 0; r < question.allowed[e].size(); ++r) {
        if (!question.allowed[e][r] || (e == resolution_effect && r != size)) continue;
        const Rung& rung = ladder.rungs[r];
        const double ms = times.empty() ? 0.0 : times[r][size];
        const double error = ladder.directed ? rung.chart_error * question.coverage[e] : 0.0;
        const bool changes = static_cast<int>(r) != question.now[e];
        const bool worse = changes && rung.chart_error > now.chart_error;
        // Of equals the one that is cheaper on the chart: measured figures are not so even.
        by_value[e].push_back({static_cast<int>(r), ms,
                               error + (changes ? change_penalty : 0.0) + (worse ? question.trade_penalty : 0.0) +
                                   (1e-5 * rung.chart_ms + 1e-6 * ms) / question.limit_ms});
        // Where nothing fits: the least time, handicapped by changes; value stands in for time.
        by_time[e].push_back({static_cast<int>(r), 0.0, ms + (changes ? saving_ms : 0.0) + 1e-6 * error});
      }
    }
    Partial found;
    if (best_within(by_value, question.limit_ms / question.spread, found) && found.value < best_value) {
      best_value = found.value;
      best.rungs = rungs_of(found);
      best.fits = true;
    }
    if (best_within(by_time, 1.0, found) && found.value < cheapest_ms) {
      cheapest_ms = found.value;
      cheapest.rungs = rungs_of(found);
    }
  }
  Answer& answer = best.fits ? best : cheapest;
  answer.ms = expected_ms(question, answer.rungs);
  answer.error = visible_error(question, answer.rungs);
  return answer;
}

}  // namespace petrichor
