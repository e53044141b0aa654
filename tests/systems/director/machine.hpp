#pragma once
// A machine that is made up: it "draws" by the director's choices and says what that took.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "systems/director/director.hpp"
#include "systems/systems.hpp"

namespace petrichor {

inline std::size_t index_of(Effect effect) {
  return static_cast<std::size_t>(effect);
}

// The real ladders with figures of the tests' own, so that a new chart does not change what they say.
inline std::vector<Ladder> charted_ladders() {
  std::vector<Ladder> ladders = all_ladders();
  const auto set = [&](Effect effect, std::vector<std::pair<double, double>> ms_error) {
    Ladder& l = ladders[index_of(effect)];
    for (std::size_t r = 0; r < l.rungs.size(); ++r) {
      l.rungs[r].chart_ms = r < ms_error.size() ? ms_error[r].first : 0.0;
      l.rungs[r].chart_error = r < ms_error.size() ? ms_error[r].second : 0.0;
      l.rungs[r].stable = true;
    }
  };
  set(Effect::rainfall, {{0, 1}, {4, 0.6}, {9, 0.55}, {15, 0.4}, {25, 0.25}, {300, 0.1}, {40, 0.2}});
  set(Effect::snow, {{0, 1}, {4, 0.6}, {20, 0.1}});
  set(Effect::antialias, {{0, 1}, {3, 0.5}});
  set(Effect::resolution, {{25, 0.3}, {35, 0.18}, {60, 0}});
  return ladders;
}

struct Machine {
  double rest_ms = 60.0;                          // at full size
  double speed = 1.0;                             // everything takes that many times the chart's figure
  std::array<double, effect_count> effect_speed;  // and effects that many times more
  std::array<double, resolution_rungs> scale{0.42, 0.6, 1.0};
  double noise = 0.0;  // uniform, +- that share
  std::function<void(std::vector<PassTime>&)> lie;
  std::mt19937 random{1};
  std::vector<Ladder> ladders = charted_ladders();

  Machine() { effect_speed.fill(1.0); }

  double uneven() { return 1.0 + std::uniform_real_distribution<double>(-noise, noise)(random); }

  double effect_ms(const Techniques& t, const std::array<double, effect_count>& coverage, std::size_t e) const {
    if (!(coverage[e] > 0.0) || e == index_of(Effect::resolution) || !ladders[e].directed) return 0.0;
    const Choice& c = t.choices[e];
    double ms = ladders[e].rungs[c.rung].chart_ms;
    if (c.blend < 1.0f) ms += ladders[e].rungs[c.from].chart_ms;  // both are drawn
    return ms * effect_speed[e] * speed * scale[t[Effect::resolution].rung];
  }
  double mean_ms(const Techniques& t, const std::array<double, effect_count>& coverage) const {
    double ms = rest_ms * speed * scale[t[Effect::resolution].rung];
    for (std::size_t e = 0; e < effect_count; ++e) ms += effect_ms(t, coverage, e);
    return ms;
  }
  std::vector<PassTime> passes(const Techniques& t, const std::array<double, effect_count>& coverage) {
    std::vector<PassTime> times{{"gbuffer", rest_ms * speed * scale[t[Effect::resolution].rung] * uneven()}};
    for (std::size_t e = 0; e < effect_count; ++e) {
      const auto& names = ladders[e].rungs[t.choices[e].rung].passes;
      const double ms = effect_ms(t, coverage, e) * uneven();
      for (const std::string_view name : names)
        if (ms > 0.0) times.push_back({std::string(name), ms / static_cast<double>(names.size())});
    }
    if (lie) lie(times);
    return times;
  }
};

struct Drawn {
  Techniques techniques;
  double ms, time_s;
  bool profiled;
};

// The director and the machine, frame after frame.
struct Rehearsal {
  Machine machine;
  Director director = make_director(charted_ladders(), Techniques());
  DirectorInput input;
  DirectorOutput output;
  std::vector<Drawn> frames;
  double time_s = 0.0;

  Rehearsal() {
    input.budget_ms = 66.0;
    input.step_s = 1.0 / 15.0;
    input.coverage[index_of(Effect::rainfall)] = 1.0;
    input.coverage[index_of(Effect::antialias)] = 0.02;
    input.coverage[index_of(Effect::resolution)] = 1.0;
  }
  void step() {
    output = direct(director, input);
    const double ms = machine.mean_ms(output.techniques, input.coverage) * machine.uneven();
    frames.push_back({output.techniques, ms, time_s, output.profile_next});
    time_s += input.step_s;
    passes_ = output.profile_next ? machine.passes(output.techniques, input.coverage) : std::vector<PassTime>();
    input.frame_ms = ms;
    input.profiled = output.profile_next;
    input.passes = passes_;
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  int rung(Effect effect) const { return output.techniques[effect].rung; }

  // Least visible error of all combinations whose p95 is under the budget; infinity where there is none.
  double best_error(double of_budget) const {
    double best = 1e9;
    each_choice([&](const Techniques& t, double error) {
      if (machine.mean_ms(t, input.coverage) * p95_of_noise() <= of_budget * input.budget_ms)
        best = std::min(best, error);
    });
    return best;
  }
  double least_ms() const {
    double least = 1e9;
    each_choice([&](const Techniques& t, double) { least = std::min(least, machine.mean_ms(t, input.coverage)); });
    return least;
  }
  double error_now() const {
    double error = 0.0;
    for (const Ladder& l : machine.ladders)
      if (l.directed)
        error += l.rungs[output.techniques[l.effect].rung].chart_error * input.coverage[index_of(l.effect)];
    return error;
  }
  double p95_of_noise() const { return 1.0 + 0.9 * machine.noise; }
  // Of the frames from `first` on, to before `end`.
  double p95(std::size_t first, std::size_t end = SIZE_MAX) const {
    std::vector<double> ms;
    for (std::size_t i = first; i < std::min(end, frames.size()); ++i) ms.push_back(frames[i].ms);
    std::sort(ms.begin(), ms.end());
    return ms[ms.size() * 95 / 100];
  }
  int switches_since(double from_s) const {
    int count = 0;
    for (const DirectorSwitch& s : director.history) count += s.time_s >= from_s;
    return count;
  }
  std::array<int, effect_count> rungs() const {
    std::array<int, effect_count> all{};
    for (std::size_t e = 0; e < effect_count; ++e) all[e] = output.techniques.choices[e].rung;
    return all;
  }
  bool fading() const {
    for (const Choice& c : output.techniques.choices)
      if (c.blend < 1.0f) return true;
    return false;
  }
  // The shortest time between two switches of one effect.
  double shortest_hold_s() const {
    double shortest = 1e9;
    std::array<double, effect_count> last;
    last.fill(-1e9);
    Techniques before = frames.front().techniques;
    for (const Drawn& drawn : frames) {
      for (std::size_t e = 0; e < effect_count; ++e) {
        if (drawn.techniques.choices[e].rung == before.choices[e].rung) continue;
        shortest = std::min(shortest, drawn.time_s - last[e]);
        last[e] = drawn.time_s;
      }
      before = drawn.techniques;
    }
    return shortest;
  }

 private:
  template <class Fn>
  void each_choice(Fn&& fn) const {
    for (int rain = 0; rain < 7; ++rain)
      for (int snow = 0; snow < 3; ++snow)
        for (int edges = 0; edges < 2; ++edges)
          for (int size = 0; size < 3; ++size) {
            Techniques t = output.techniques;
            for (Choice& c : t.choices) c.blend = 1.0f;
            if (!input.pinned[index_of(Effect::rainfall)]) t.set(Effect::rainfall, rain);
            if (!input.pinned[index_of(Effect::snow)]) t.set(Effect::snow, snow);
            if (!input.pinned[index_of(Effect::antialias)]) t.set(Effect::antialias, edges);
            if (!input.pinned[index_of(Effect::resolution)]) t.set(Effect::resolution, size);
            double error = 0.0;
            for (const Ladder& l : machine.ladders)
              if (l.directed) error += l.rungs[t[l.effect].rung].chart_error * input.coverage[index_of(l.effect)];
            fn(t, error);
          }
  }
  std::vector<PassTime> passes_;
};

}  // namespace petrichor
