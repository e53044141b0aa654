#include "systems/director/director.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "systems/director/choose.hpp"

namespace petrichor {
namespace {

constexpr std::size_t longest_recent = 180, longest_unevenness = 240;
constexpr double drop_limit = 0.93;   // of the budget: what a choice is meant to fill at most
constexpr double least_gain = 0.004;  // of visible error: for less nobody climbs
constexpr int wish_frames_needed = 8;
constexpr double climb_after_s = 0.3, wish_needed_s = 0.2;
constexpr double failed_within_s = 120.0, shortest_bar_s = 4.0, first_bar_s = 8.0, longest_bar_s = 600.0,
                 proven_after_s = 180.0;
constexpr double soon_s = 20.0, first_rest_s = 3.0, longest_rest_s = 120.0;
constexpr double trade_penalty = 0.1, despair_after_s = 3.0;
constexpr double load_gone = 0.75;     // of the frame that was expected after the failure
constexpr double much_lighter = 0.85;  // the rest of the frame, for a climb that failed to be tried early
constexpr int profile_every = 30, profile_soon = 6;
constexpr std::size_t history_kept = 4096;

std::size_t index(Effect effect) {
  return static_cast<std::size_t>(effect);
}

// The less even the frames, the more of them and the more room a climb needs.
double climb_limit(const Director& d) {
  return 0.86 - 0.15 * (director_spread(d) - 1.0);
}
std::size_t frames_to_know(const Director& d, double least) {
  return static_cast<std::size_t>(std::clamp(least + 100.0 * (director_spread(d) - 1.05), least, 35.0));
}

bool fades(const Director& d, std::size_t e) {
  return d.effects[e].choice.blend < 1.0f;
}
bool any_fades(const Director& d) {
  for (std::size_t e = 0; e < effect_count; ++e)
    if (fades(d, e)) return true;
  return false;
}

Techniques techniques_of(const Director& d) {
  Techniques techniques;
  for (std::size_t e = 0; e < effect_count; ++e) techniques.choices[e] = d.effects[e].choice;
  return techniques;
}

Rungs rungs_of(const Director& d) {
  Rungs rungs{};
  for (std::size_t e = 0; e < effect_count; ++e) rungs[e] = d.effects[e].choice.rung;
  return rungs;
}

void begin_regime(Director& d, int settling) {
  d.recent_ms.clear();
  d.regime_s = 0.0;
  d.settling = std::max(d.settling, settling);
  d.wish_s = 0.0;
  d.wish_frames = 0;
}

void keep_last(std::vector<double>& values, std::size_t count) {
  if (values.size() > count) values.erase(values.begin(), values.end() - static_cast<std::ptrdiff_t>(count));
}

std::vector<double> last(const std::vector<double>& values, std::size_t count) {
  return {values.end() - static_cast<std::ptrdiff_t>(std::min(count, values.size())), values.end()};
}

void switch_to(Director& d, std::size_t e, int rung, double fade_s, const char* reason, double expected) {
  DirectedEffect& effect = d.effects[e];
  const Ladder& ladder = d.costs.ladders[e];
  const int from = effect.choice.rung;
  const bool truer = ladder.rungs[static_cast<std::size_t>(rung)].chart_error <
                     ladder.rungs[static_cast<std::size_t>(from)].chart_error;
  if (truer) effect.since_climb_s = 0.0;
  effect.choice = {static_cast<std::uint8_t>(rung), static_cast<std::uint8_t>(fade_s > 0.0 ? from : rung),
                   fade_s > 0.0 ? 0.0f : 1.0f};
  effect.fade_s = fade_s;
  effect.since_switch_s = 0.0;
  ++effect.switches;
  if (d.history.size() < history_kept)
    d.history.push_back({d.frame, d.time_s, ladder.effect, from, rung, d.level_ms, expected, reason});
}

// What was climbed to a short while ago and has to be left again was a mistake.
void bar_failed_climb(Director& d, std::size_t e, const CostTable& table) {
  DirectedEffect& effect = d.effects[e];
  const std::size_t rung = effect.choice.rung;
  effect.barred_s[rung] = std::max(effect.barred_s[rung], shortest_bar_s);
  if (effect.since_climb_s > failed_within_s) return;
  if (effect.since_climb_s < soon_s && d.since_failure_s > 0.0) {
    d.rested_s = d.rested_s > 0.0 ? std::min(2.0 * d.rested_s, longest_rest_s) : first_rest_s;
    d.rest_s = d.rested_s;
    d.since_failure_s = 0.0;
  }
  effect.bar_s[rung] = effect.bar_s[rung] > 0.0 ? std::min(2.0 * effect.bar_s[rung], longest_bar_s) : first_bar_s;
  effect.barred_s[rung] = effect.bar_s[rung];
  const std::size_t size = d.effects[index(Effect::resolution)].choice.rung;
  effect.failed_rest_ms[rung] = e == index(Effect::resolution) ? d.level_ms : d.level_ms - table.ms[e][rung][size];
}

Question question(const Director& d, const CostTable& table, double limit_ms) {
  Question q;
  q.ladders = &d.costs.ladders;
  q.table = &table;
  q.coverage = d.coverage;
  q.now = rungs_of(d);
  q.spread = director_spread(d);
  q.limit_ms = limit_ms;
  for (std::size_t e = 0; e < effect_count; ++e) {
    const Ladder& ladder = d.costs.ladders[e];
    q.allowed[e].assign(ladder.rungs.size(), 0);
    q.allowed[e][static_cast<std::size_t>(q.now[e])] = 1;
    if (!d.effects[e].free || !(d.coverage[e] > 0.0) || d.effects[e].since_switch_s < director_hold_s) continue;
    for (std::size_t r = 0; r < ladder.rungs.size(); ++r)
      if (usable(ladder.rungs[r]) && !outdone(ladder, ladder.rungs[r])) q.allowed[e][r] = 1;
  }
  return q;
}

// Over budget: only downwards.
void forbid_climbs(const Director& d, Question& q, const CostTable& table) {
  const std::size_t size = static_cast<std::size_t>(q.now[index(Effect::resolution)]);
  for (std::size_t e = 0; e < effect_count; ++e) {
    const auto& rungs = d.costs.ladders[e].rungs;
    const std::size_t now = static_cast<std::size_t>(q.now[e]);
    for (std::size_t r = 0; r < rungs.size(); ++r) {
      const bool cheaper = e == index(Effect::resolution) ? r < now
                                                          : table.ms[e][r][size] < table.ms[e][now][size] &&
                                                                rungs[r].chart_error >= rungs[now].chart_error;
      if (r != now && !cheaper) q.allowed[e][r] = 0;
    }
  }
}

void forbid_barred(const Director& d, Question& q, const CostTable& table) {
  const std::size_t size = static_cast<std::size_t>(q.now[index(Effect::resolution)]);
  for (std::size_t e = 0; e < effect_count; ++e) {
    const DirectedEffect& effect = d.effects[e];
    const std::size_t now = static_cast<std::size_t>(q.now[e]);
    const double rest_ms = e == index(Effect::resolution) ? d.level_ms : d.level_ms - table.ms[e][now][size];
    for (std::size_t r = 0; r < effect.barred_s.size(); ++r)
      if (r != now && effect.barred_s[r] > 0.0 && rest_ms > much_lighter * effect.failed_rest_ms[r])
        q.allowed[e][r] = 0;
  }
}

bool apply(Director& d, const Question& q, const Answer& answer, const CostTable& table, const char* reason,
           const std::array<bool, effect_count>& unseen = {}) {
  if (answer.rungs == q.now) return false;
  const std::size_t size = static_cast<std::size_t>(q.now[index(Effect::resolution)]);
  for (std::size_t e = 0; e < effect_count; ++e) {
    if (answer.rungs[e] == q.now[e]) continue;
    const auto& rungs = d.costs.ladders[e].rungs;
    const std::size_t from = static_cast<std::size_t>(q.now[e]), to = static_cast<std::size_t>(answer.rungs[e]);
    if (rungs[to].chart_error > rungs[from].chart_error) bar_failed_climb(d, e, table);
    // Both are drawn while they give way: where that asks too much it is got over with sooner.
    double fade_s = d.costs.ladders[e].fades && !unseen[e] ? director_fade_s : 0.0;
    if ((d.level_ms + table.ms[e][to][size]) > 1.25 * d.budget_ms) fade_s *= 0.5;
    switch_to(d, e, answer.rungs[e], fade_s, reason, answer.ms);
  }
  d.learning = true;
  d.learn_from = q.now;
  d.learn_to = answer.rungs;
  d.learn_from_ms = d.level_ms;
  d.learn_expected_ms = answer.ms;
  if (d.since_failure_s == 0.0) d.rest_from_ms = answer.ms;
  d.new_rungs = true;
  begin_regime(d, 2);
  return true;
}

void follow_the_user(Director& d, const DirectorInput& in) {
  for (std::size_t e = 0; e < effect_count; ++e) {
    const Choice& asked = in.asked.choices[e];
    DirectedEffect& effect = d.effects[e];
    effect.free = in.budget_ms > 0.0 && d.costs.ladders[e].directed && !in.pinned[e];
    if (effect.free || (effect.choice.rung == asked.rung && effect.choice.blend == asked.blend)) continue;
    effect.choice = asked;
    begin_regime(d, 2);
  }
}

void advance_clocks(Director& d, double step_s) {
  d.time_s += step_s;
  d.regime_s += step_s;
  d.rest_s = std::max(d.rest_s - step_s, 0.0);
  d.since_failure_s += step_s;
  if (d.since_failure_s > proven_after_s + d.rested_s) d.rested_s = 0.0;
  ++d.frame;
  for (DirectedEffect& effect : d.effects) {
    effect.since_switch_s += step_s;
    effect.since_climb_s += step_s;
    for (double& barred : effect.barred_s) barred = std::max(barred - step_s, 0.0);
    // A rung that held is forgiven its failures.
    if (effect.since_climb_s > proven_after_s && effect.since_switch_s > proven_after_s)
      effect.bar_s[effect.choice.rung] = 0.0;
    Choice& c = effect.choice;
    if (c.blend >= 1.0f) continue;
    c.blend = effect.fade_s > 0.0 ? std::min(c.blend + static_cast<float>(step_s / effect.fade_s), 1.0f) : 1.0f;
    if (c.blend > 0.999f) {
      c.blend = 1.0f;
      c.from = c.rung;
      begin_regime(d, 2);
    }
  }
}

// Frames since the last change; the spread about their median is learned from all.
void take_frame(Director& d, const DirectorInput& in) {
  if (!(in.frame_ms > 0.0) || !std::isfinite(in.frame_ms)) return;
  if (in.profiled || any_fades(d)) return;
  if (d.settling > 0) {
    --d.settling;
    return;
  }
  if (d.recent_ms.size() >= 12) {
    d.unevenness.push_back(in.frame_ms / std::max(median_of(d.recent_ms), 1e-6));
    keep_last(d.unevenness, longest_unevenness);
  }
  d.recent_ms.push_back(in.frame_ms);
  keep_last(d.recent_ms, longest_recent);
  // Much lighter than before: what was before says nothing any more.
  if (d.recent_ms.size() >= 20) {
    std::vector<double> before = d.recent_ms;
    before.resize(before.size() - 9);
    if (median_of(last(d.recent_ms, 9)) < 0.75 * median_of(before)) keep_last(d.recent_ms, 9);
  }
}

// Is the frame over its budget, and how long is it? Sudden and plain, or slight and for long.
bool over_budget(Director& d) {
  const std::size_t n = d.recent_ms.size();
  if (n >= 4) {
    const std::vector<double> four = last(d.recent_ms, 4);
    const double low = *std::min_element(four.begin(), four.end());
    if (low > d.budget_ms || (n >= 8 && median_of(last(d.recent_ms, 8)) > d.budget_ms)) {
      keep_last(d.recent_ms, low > d.budget_ms ? 4 : 8);
      d.level_ms = median_of(d.recent_ms);
      return true;
    }
  }
  if (n < 4) return false;
  d.level_ms = median_of(d.recent_ms);
  if (n >= 90) {
    std::vector<double> sorted = d.recent_ms;
    std::sort(sorted.begin(), sorted.end());
    if (sorted[n * 95 / 100] > 1.01 * d.budget_ms) return true;
  }
  if (n < 20 || median_of(last(d.recent_ms, 30)) * director_spread(d) < 1.06 * d.budget_ms) return false;
  keep_last(d.recent_ms, 30);
  d.level_ms = median_of(d.recent_ms);
  return true;
}

void check_last_change(Director& d, std::size_t frames) {
  learn_change(d.costs, d.learn_from, d.learn_to, d.coverage, d.learn_from_ms, d.learn_expected_ms,
               median_of(last(d.recent_ms, frames)), director_spread(d) - 1.0);
  d.learning = false;
}

void learn(Director& d, const DirectorInput& in) {
  // Times come a few frames late on hardware, so they wait until the frames are surely of these rungs.
  const bool settled = !any_fades(d) && d.settling == 0 && (in.profiled || d.recent_ms.size() >= 6);
  if (settled && !in.passes.empty()) {
    learn_passes(d.costs, techniques_of(d), d.coverage, in.passes, in.frame_ms, in.gpu_times);
    d.new_rungs = false;
  }
  if (const std::size_t needed = frames_to_know(d, 7.0); d.learning && d.recent_ms.size() >= needed)
    check_last_change(d, needed);
}

// Effects that came into the picture: at once, while nobody has seen them yet.
bool receive(Director& d, const std::array<bool, effect_count>& appeared) {
  if (!(d.level_ms > 0.0)) return false;
  const Techniques techniques = techniques_of(d);
  CostTable table = cost_table(d.costs, techniques, d.coverage, d.level_ms);
  const std::size_t size = techniques[Effect::resolution].rung;
  for (std::size_t e = 0; e < effect_count; ++e)
    if (appeared[e]) d.level_ms += table.ms[e][techniques.choices[e].rung][size];
  table = cost_table(d.costs, techniques, d.coverage, d.level_ms);
  Question q = question(d, table, climb_limit(d) * d.budget_ms);
  for (std::size_t e = 0; e < effect_count; ++e)
    if (!appeared[e]) q.allowed[e].assign(q.allowed[e].size(), 0), q.allowed[e][static_cast<std::size_t>(q.now[e])] = 1;
  forbid_barred(d, q, table);
  return apply(d, q, choose(q), table, "appeared", appeared);
}

// Over budget for long, and nothing is thought to help: then what is thought is wrong. What the chart calls cheaper is
// tried, one effect at a time, sharpness first.
bool despair(const Director& d, const Question& q, Answer& answer) {
  if (answer.rungs != q.now || d.regime_s < despair_after_s) return false;
  const std::size_t size = index(Effect::resolution);
  for (std::size_t i = 0; i < effect_count; ++i) {
    const std::size_t e = i == 0 ? size : i - 1;  // resolution is the last of the effects
    const auto& rungs = d.costs.ladders[e].rungs;
    std::size_t cheapest = static_cast<std::size_t>(q.now[e]);
    for (std::size_t r = 0; r < rungs.size(); ++r)
      if (d.effects[e].free && d.coverage[e] > 0.0 && usable(rungs[r]) &&
          d.effects[e].since_switch_s >= director_hold_s && rungs[r].chart_ms < rungs[cheapest].chart_ms)
        cheapest = r;
    const double saving_ms = rungs[static_cast<std::size_t>(q.now[e])].chart_ms - rungs[cheapest].chart_ms;
    if (saving_ms <= 0.15 * d.costs.ladders[size].rungs.back().chart_ms) continue;  // of a charted frame: no help
    answer.rungs[e] = static_cast<int>(cheapest);
    answer.ms = expected_ms(q, answer.rungs);
    return true;
  }
  return false;
}

void decide(Director& d, double step_s) {
  const bool over = over_budget(d);
  if (!over && (d.recent_ms.size() < frames_to_know(d, 15.0) || d.regime_s < climb_after_s)) return;
  if (over && d.learning) check_last_change(d, d.recent_ms.size());
  const CostTable table = cost_table(d.costs, techniques_of(d), d.coverage, d.level_ms);
  Question q = question(d, table, (over ? drop_limit : climb_limit(d)) * d.budget_ms);
  if (over) {
    d.wish_s = 0.0;
    d.wish_frames = 0;
    forbid_climbs(d, q, table);
    Answer answer = choose(q);
    const bool at_a_loss = despair(d, q, answer);
    apply(d, q, answer, table, at_a_loss ? "over budget, and nothing that should help did" : "over budget");
    return;
  }
  if (d.rest_s > 0.0 && d.level_ms > load_gone * d.rest_from_ms) return;
  q.trade_penalty = trade_penalty;
  forbid_barred(d, q, table);
  const Answer answer = choose(q);
  const bool wanted = answer.fits && visible_error(q, q.now) - answer.error > least_gain;
  if (!wanted || answer.rungs != d.wish) {
    d.wish = answer.rungs;
    d.wish_s = 0.0;
    d.wish_frames = 0;
    return;
  }
  d.wish_s += step_s;
  if (++d.wish_frames >= wish_frames_needed && d.wish_s >= wish_needed_s) apply(d, q, answer, table, "room to spare");
}

}  // namespace

double director_spread(const Director& d) {
  constexpr double unknown = 1.15, least = 1.04, most = 1.4;
  constexpr std::size_t enough = 30;
  if (d.unevenness.size() < enough) return unknown;
  std::vector<double> sorted = d.unevenness;
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 95 / 100);
  std::nth_element(sorted.begin(), at, sorted.end());
  return std::clamp(*at, least, most);
}

Director make_director(std::vector<Ladder> ladders, const Techniques& start) {
  Director d;
  d.costs = make_costs(std::move(ladders));
  for (std::size_t e = 0; e < effect_count; ++e) {
    const std::size_t rungs = d.costs.ladders[e].rungs.size();
    d.effects[e].choice = start.choices[e];
    d.effects[e].barred_s.assign(rungs, 0.0);
    d.effects[e].bar_s.assign(rungs, 0.0);
    d.effects[e].failed_rest_ms.assign(rungs, 0.0);
  }
  return d;
}

DirectorOutput direct(Director& d, const DirectorInput& in) {
  const double step_s = std::isfinite(in.step_s) ? std::clamp(in.step_s, 0.0, 1.0) : 0.0;
  d.budget_ms = std::isfinite(in.budget_ms) ? std::max(in.budget_ms, 0.0) : 0.0;
  take_frame(d, in);  // of the choices as they were
  learn(d, in);
  advance_clocks(d, step_s);
  follow_the_user(d, in);
  std::array<bool, effect_count> appeared{};
  bool some_appeared = false;
  for (std::size_t e = 0; e < effect_count; ++e) {
    const bool was = d.coverage[e] > 0.0, is = in.coverage[e] > 0.0;
    if (was != is && d.costs.ladders[e].directed) begin_regime(d, 0);
    if (was != is) d.learning = false;
    appeared[e] = !was && is && d.effects[e].free && d.effects[e].since_switch_s >= director_hold_s;
    some_appeared |= appeared[e];
    d.coverage[e] = in.coverage[e];
  }
  if (!(d.budget_ms > 0.0)) return {techniques_of(d), false};
  if (!(some_appeared && receive(d, appeared)) && !any_fades(d) && d.settling == 0) decide(d, step_s);

  const bool due = d.frame - d.profiled_at >= profile_every ||
                   (d.new_rungs && d.frame - d.profiled_at >= profile_soon && d.recent_ms.size() >= 4);
  DirectorOutput out{techniques_of(d), due && !any_fades(d) && d.settling == 0};
  if (out.profile_next) d.profiled_at = d.frame;
  return out;
}

}  // namespace petrichor
