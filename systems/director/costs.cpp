#include "systems/director/costs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace petrichor {
namespace {

constexpr std::size_t resolution_effect = static_cast<std::size_t>(Effect::resolution);
constexpr std::size_t full_size = static_cast<std::size_t>(ResolutionRung::full);
constexpr double least_chart_ms = 1e-4;  // of smaller figures no ratio is made
constexpr double wildest_ratio = 5.0;    // an effect's ratio to the chart against that of the whole frame
constexpr double least_rest = 0.1;       // of a frame: there is always something besides the effects
constexpr double wildest_scale = 1.5;    // of what a size saves, against the chart
constexpr double least_surprise = 0.15;  // of a frame
constexpr int doubts_to_distrust = 2;
constexpr double outdone_by = 0.8;

void add(CostSamples& samples, double ms) {
  samples.ms[samples.next] = ms;
  samples.next = (samples.next + 1) % static_cast<int>(samples.ms.size());
  samples.count = std::min(samples.count + 1, static_cast<int>(samples.ms.size()));
}
double median(const CostSamples& s) {  // 0 for none
  return petrichor::median_of(std::vector<double>(s.ms.begin(), s.ms.begin() + s.count));
}

// An effect with passes of its own that the director may move, and that is in the picture.
bool counts(const Ladder& ladder, const std::array<double, effect_count>& coverage) {
  const auto e = static_cast<std::size_t>(ladder.effect);
  return ladder.directed && e != resolution_effect && coverage[e] > 0.0;
}

// Of a pass that several ladders' rungs name (films and puddles share one), the part that is one's own: by their charts.
double part_of_pass(const std::vector<Ladder>& ladders, const Techniques& techniques,
                    const std::array<double, effect_count>& coverage, std::string_view pass, double own_chart_ms) {
  double all_ms = 0.0;
  int asking = 0;
  for (const Ladder& ladder : ladders) {
    if (!counts(ladder, coverage)) continue;
    const Rung& rung = ladder.rungs[techniques[ladder.effect].rung];
    if (std::find(rung.passes.begin(), rung.passes.end(), pass) == rung.passes.end()) continue;
    all_ms += rung.chart_ms;
    ++asking;
  }
  return asking > 1 && all_ms > 0.0 ? own_chart_ms / all_ms : 1.0;
}

// Ratio of this machine to the chart's by the whole frame; 0 where it cannot be told.
double frame_ratio(const DirectorCosts& costs, const Techniques& techniques,
                   const std::array<double, effect_count>& coverage, double level_ms) {
  const auto size = techniques[Effect::resolution].rung;
  double chart_ms = costs.ladders[resolution_effect].rungs[full_size].chart_ms;
  if (!(chart_ms > least_chart_ms) || !(level_ms > 0.0)) return 0.0;
  for (const Ladder& ladder : costs.ladders)
    if (counts(ladder, coverage)) chart_ms += ladder.rungs[techniques[ladder.effect].rung].chart_ms;
  return std::max(level_ms - median(costs.beside), least_rest * level_ms) / (chart_ms * costs.scale[size]);
}

void collect_ratios(const DirectorCosts& costs, std::size_t e, std::vector<double>& ratios) {
  const Ladder& ladder = costs.ladders[e];
  for (std::size_t r = 0; r < ladder.rungs.size(); ++r)
    for (std::size_t q = 0; q < resolution_rungs; ++q)
      if (costs.measured[e][r][q].count && ladder.rungs[r].chart_ms > least_chart_ms)
        ratios.push_back(median(costs.measured[e][r][q]) / (ladder.rungs[r].chart_ms * costs.scale[q]));
}

void forget_measured(DirectorCosts& costs) {
  for (auto& rungs : costs.measured)
    for (auto& sizes : rungs) sizes = {};
}

constexpr int long_memory = 1000;  // of profiles

void distrust(DirectorCosts& costs, int by) {
  const bool believed = costs.trust >= 2;
  costs.trust = std::max(costs.trust - by, -long_memory);
  if (believed && costs.trust < 2) forget_measured(costs);  // what it said before was no better
}

}  // namespace

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool usable(const Rung& rung) {
  return rung.stable && (rung.chart_ms > 0.0 || rung.chart_error > 0.0);
}

bool outdone(const Ladder& ladder, const Rung& rung) {
  return std::any_of(ladder.rungs.begin(), ladder.rungs.end(), [&](const Rung& other) {
    return usable(other) && other.chart_error <= rung.chart_error && other.chart_ms < outdone_by * rung.chart_ms;
  });
}

DirectorCosts make_costs(std::vector<Ladder> ladders) {
  DirectorCosts costs;
  costs.ladders = std::move(ladders);
  for (const Ladder& ladder : costs.ladders)
    costs.measured[static_cast<std::size_t>(ladder.effect)].resize(ladder.rungs.size());
  costs.scale = {0.45, 0.6, 1.0};  // where the chart does not say
  const auto& sizes = costs.ladders[resolution_effect].rungs;
  const double full_ms = sizes[full_size].chart_ms;
  for (std::size_t q = 0; q < resolution_rungs && full_ms > least_chart_ms; ++q)
    if (sizes[q].chart_ms > least_chart_ms) costs.scale[q] = std::min(sizes[q].chart_ms / full_ms, 1.0);
  costs.chart_scale = costs.scale;
  return costs;
}

CostTable cost_table(const DirectorCosts& costs, const Techniques& techniques,
                     const std::array<double, effect_count>& coverage, double level_ms) {
  CostTable table;
  const double by_frame = frame_ratio(costs, techniques, coverage, level_ms);
  std::vector<double> all_ratios;
  for (std::size_t e = 0; e < effect_count; ++e)
    if (e != resolution_effect) collect_ratios(costs, e, all_ratios);
  const double overall = !all_ratios.empty() ? median_of(all_ratios) : by_frame > 0.0 ? by_frame : 1.0;
  const auto size = techniques[Effect::resolution].rung;
  double of_effects_ms = 0.0;
  for (std::size_t e = 0; e < effect_count; ++e) {
    const Ladder& ladder = costs.ladders[e];
    table.ms[e].assign(ladder.rungs.size(), {});
    if (!counts(ladder, coverage)) continue;
    std::vector<double> ratios;
    collect_ratios(costs, e, ratios);
    double ratio = ratios.empty() ? overall : median_of(ratios);
    if (by_frame > 0.0) ratio = std::clamp(ratio, by_frame / wildest_ratio, by_frame * wildest_ratio);
    for (std::size_t r = 0; r < ladder.rungs.size(); ++r)
      for (std::size_t q = 0; q < resolution_rungs; ++q) {
        const auto& sizes = costs.measured[e][r];
        double ms = ladder.rungs[r].chart_ms * costs.scale[q] * ratio;
        // Measured at another size, rather than charted.
        std::size_t nearest = resolution_rungs;
        for (std::size_t other = 0; other < resolution_rungs; ++other) {
          const auto away = [&](std::size_t at) { return at > q ? at - q : q - at; };
          if (sizes[other].count && (nearest == resolution_rungs || away(other) < away(nearest))) nearest = other;
        }
        if (nearest != resolution_rungs) ms = median(sizes[nearest]) * costs.scale[q] / costs.scale[nearest];
        // What was measured under another load must not bar a rung for ever; the one that is drawn is known.
        const double charted_ms = ladder.rungs[r].chart_ms * costs.scale[q] * by_frame;
        if (charted_ms > least_chart_ms && r != techniques[ladder.effect].rung)
          ms = std::min(ms, wildest_ratio * charted_ms);
        table.ms[e][r][q] = ms;
      }
    of_effects_ms += table.ms[e][techniques[ladder.effect].rung][size];
  }
  const double rest_ms = std::max(level_ms - of_effects_ms, least_rest * level_ms);
  const double beside_ms = std::min(median(costs.beside), rest_ms);
  for (std::size_t q = 0; q < resolution_rungs; ++q)
    table.ms[resolution_effect][q].fill(beside_ms + (rest_ms - beside_ms) * costs.scale[q] / costs.scale[size]);
  return table;
}

void learn_passes(DirectorCosts& costs, const Techniques& techniques, const std::array<double, effect_count>& coverage,
                  std::span<const PassTime> passes, double frame_ms, bool gpu_times) {
  if (passes.empty() || !(frame_ms > 0.0) || !std::isfinite(frame_ms)) return;
  double sum = 0.0;
  bool sane = true;
  for (const PassTime& pass : passes) {
    sane &= std::isfinite(pass.ms) && pass.ms >= 0.0;
    sum += pass.ms;
  }
  if (!sane || sum <= (gpu_times ? 0.0 : 0.3 * frame_ms) || sum > 2.0 * frame_ms)
    return distrust(costs, costs.trust > -10 ? 2 : 0);
  costs.trust = std::min(costs.trust + 1, 3);
  if (costs.trust < 2) return;
  if (gpu_times) add(costs.beside, std::max(frame_ms - sum, 0.0));
  const auto size = techniques[Effect::resolution].rung;
  for (const Ladder& ladder : costs.ladders) {
    if (!counts(ladder, coverage)) continue;
    const auto e = static_cast<std::size_t>(ladder.effect);
    const auto rung = techniques[ladder.effect].rung;
    double ms = 0.0;
    for (const std::string_view name : ladder.rungs[rung].passes) {
      const double part = part_of_pass(costs.ladders, techniques, coverage, name, ladder.rungs[rung].chart_ms);
      for (const PassTime& pass : passes)
        if (pass.name == name) ms += part * pass.ms;
    }
    add(costs.measured[e][rung][size], ms);
  }
}

void learn_change(DirectorCosts& costs, const std::array<int, effect_count>& from,
                  const std::array<int, effect_count>& to, const std::array<double, effect_count>& coverage,
                  double before_ms, double expected_ms, double after_ms, double noise) {
  Techniques then;
  for (std::size_t e = 0; e < effect_count; ++e) then.set(static_cast<Effect>(e), from[e]);
  const CostTable table = cost_table(costs, then, coverage, before_ms);
  const auto size_from = static_cast<std::size_t>(from[resolution_effect]);
  const auto size_to = static_cast<std::size_t>(to[resolution_effect]);
  // Each change answers for as much of the surprise as it was thought to matter.
  std::array<double, effect_count> weight{};
  double sum = 0.0;
  double dearer_ms = 0.0;  // by the chart
  for (std::size_t e = 0; e < effect_count; ++e) {
    if (from[e] == to[e]) continue;
    weight[e] = e == resolution_effect
                    ? std::abs(table.ms[e][size_to][size_to] - table.ms[e][size_from][size_from])
                    : std::abs(table.ms[e][to[e]][size_to] - table.ms[e][from[e]][size_from]) + 1e-3 * before_ms;
    const auto& rungs = costs.ladders[e].rungs;
    if (e != resolution_effect)
      dearer_ms += rungs[static_cast<std::size_t>(to[e])].chart_ms - rungs[static_cast<std::size_t>(from[e])].chart_ms;
    sum += weight[e];
  }
  if (!(sum > 0.0)) return;
  const double surprise = after_ms - expected_ms;
  const bool surprising = std::abs(surprise) > std::max(least_surprise, 1.5 * noise) * before_ms;
  if (size_from == size_to && dearer_ms != 0.0) {
    const int says = surprising ? (surprise * dearer_ms > 0.0 ? 1 : -1) : 0;
    costs.doubt = says * costs.doubt > 0 ? costs.doubt + says : says;
    if (std::abs(costs.doubt) >= doubts_to_distrust && costs.trust >= 2) {
      costs.doubt = 0;
      distrust(costs, 2 << std::min(costs.caught++, 9));  // each time it is caught it is believed later
    }
  }
  for (std::size_t e = 0; e < effect_count; ++e) {
    if (from[e] == to[e]) continue;
    const double share_ms = surprise * weight[e] / sum;
    if (e == resolution_effect) {
      const double expected_rest = table.ms[e][size_to][size_to];
      if (!(expected_rest > 0.0)) continue;
      const double factor =
          std::pow(std::clamp((expected_rest + share_ms) / expected_rest, 0.5, 2.0), 0.7 - 0.5 * std::min(noise, 0.6));
      if (size_to != full_size)
        costs.scale[size_to] *= factor;
      else
        costs.scale[size_from] /= factor;
      for (std::size_t q = resolution_rungs - 1; q-- > 0;)
        costs.scale[q] = std::min(
            std::clamp(costs.scale[q], costs.chart_scale[q] / wildest_scale, costs.chart_scale[q] * wildest_scale),
            0.97 * costs.scale[q + 1]);
    } else if (costs.trust < 2 && surprising) {  // else the chart's ratios are as good
      const double expected = table.ms[e][to[e]][size_to];
      const double found = std::clamp(expected + share_ms, 0.0, 3.0 * expected + 0.1 * before_ms);
      // Twice: one frame's noise does not outvote it. What the new rung cannot have saved, the old one cost.
      for (int i = 0; i < 2; ++i) add(costs.measured[e][to[e]][size_to], found);
      const double old_ms = table.ms[e][from[e]][size_from];
      if (expected + share_ms < 0.0)
        for (int i = 0; i < 2; ++i)
          add(costs.measured[e][from[e]][size_from],
              std::min(old_ms - (expected + share_ms), 3.0 * old_ms + 0.1 * before_ms));
    }
  }
}

}  // namespace petrichor
