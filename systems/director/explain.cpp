#include <fmt/format.h>

#include <algorithm>

#include "systems/director/director.hpp"

namespace petrichor {
namespace {

constexpr std::size_t resolution_effect = static_cast<std::size_t>(Effect::resolution);

// The least truer rung that may be chosen; null: this is the truest.
const Rung* next_truer(const Ladder& ladder, const Rung& now) {
  const Rung* next = nullptr;
  for (const Rung& rung : ladder.rungs)
    if (usable(rung) && rung.chart_error < now.chart_error && (!next || rung.chart_error > next->chart_error))
      next = &rung;
  return next;
}

std::string reason(const Director& d, std::size_t e, const CostTable& table) {
  const DirectedEffect& effect = d.effects[e];
  const Ladder& ladder = d.costs.ladders[e];
  const Rung& now = ladder.rungs[effect.choice.rung];
  if (!(d.budget_ms > 0.0)) return "the director rests: there is no budget";
  if (!effect.free) return "as you asked";
  if (!(d.coverage[e] > 0.0)) return "not in the picture";
  const Rung* next = next_truer(ladder, now);
  if (!next) return "the truest there is";
  const auto at = static_cast<std::size_t>(next - ladder.rungs.data());
  const std::size_t size = d.effects[resolution_effect].choice.rung;
  const bool is_size = e == resolution_effect;
  const double now_ms = is_size ? table.ms[e][size][size] : table.ms[e][effect.choice.rung][size];
  const double need_ms = is_size ? table.ms[e][at][at] : table.ms[e][at][size];
  const double left_ms = std::max(d.budget_ms / director_spread(d) - (d.level_ms - now_ms), 0.0);
  const std::string need = fmt::format("{} would need {:.1f} ms, {:.1f} are left", next->name, need_ms, left_ms);
  if (effect.barred_s[at] > 0.0)
    return fmt::format("{} failed; tried again in {:.0f} s or when the frame is much lighter", next->name,
                       effect.barred_s[at]);
  if (d.rest_s > 0.0 && need_ms < left_ms)
    return fmt::format("a climb failed; nothing is tried for {:.0f} s", d.rest_s);
  if (effect.since_switch_s < director_hold_s && need_ms < left_ms) return "changed a moment ago";
  return need_ms < left_ms ? need + "; it needs some room to spare" : need;
}

}  // namespace

std::vector<DirectorNote> explain(const Director& d) {
  Techniques techniques;
  for (std::size_t e = 0; e < effect_count; ++e) techniques.choices[e] = d.effects[e].choice;
  const CostTable table = cost_table(d.costs, techniques, d.coverage, d.level_ms);
  const std::size_t size = techniques[Effect::resolution].rung;
  std::vector<DirectorNote> notes;
  for (const Ladder& ladder : d.costs.ladders) {
    if (!ladder.directed) continue;
    const auto e = static_cast<std::size_t>(ladder.effect);
    const Choice& choice = d.effects[e].choice;
    const Rung& rung = ladder.rungs[choice.rung];
    DirectorNote note;
    note.effect = ladder.name;
    note.rung = rung.name;
    note.ms = table.ms[e][choice.rung][size];
    note.error = rung.chart_error;
    note.coverage = d.coverage[e];
    note.switches = d.effects[e].switches;
    note.why = reason(d, e, table);
    if (choice.blend < 1.0f) note.why = fmt::format("{} gives way; {}", ladder.rungs[choice.from].name, note.why);
    notes.push_back(std::move(note));
  }
  return notes;
}

}  // namespace petrichor
