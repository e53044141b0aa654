#include "systems/ripple/lattice.hpp"

#include <algorithm>
#include <cmath>

#include "systems/ripple/history.hpp"
#include "systems/ripple/seeds.hpp"
#include "systems/ripple/waves.hpp"

namespace petrichor {

float seed_cells(const RippleSettings& settings, int cells) {
  return std::min(settings.seed_cells, std::max(settings.seed_cells * static_cast<float>(cells) / 256.0f, 1.5f));
}

void RippleLattice::rest(int cells_now, bool near_now) {
  const std::size_t plane = static_cast<std::size_t>(cells_now) * cells_now * 4, planes = near_now ? 3 : 2;
  if (cells != cells_now || near != near_now || state.bytes < plane * planes) {
    state = make_buffer(plane * planes);
    next = make_buffer(plane * planes);
    stamps = make_buffer(plane);
    clear_buffer(stamps);
  }
  cells = cells_now;
  near = near_now;
  last_step_s = 0.0;
  clear_buffer(state);
}

void RippleLattice::step(const RipplePrograms& programs, const RippleScheme& scheme, double speed_mps, double cell_m,
                         double decay_per_s, double step_s, glm::ivec2 shift, const Buffer& seeds, int first_seed,
                         int seed_count) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RIPPLE_STAMPS_BINDING, stamps.id);
  if (seed_count > 0) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RIPPLE_SEEDS_BINDING, seeds.id);
    programs.stamp->use();
    programs.stamp->set("cells", cells);
    programs.stamp->set("first_seed", first_seed);
    programs.stamp->set("repeated", int(!near));
    glDispatchCompute(static_cast<GLuint>(seed_count), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }
  const double most = scheme.nine_share == 1.0f ? courant_9 : courant_5;
  const int steps = scheme.steps > 0 ? scheme.steps : substeps(speed_mps, step_s, cell_m, most);
  const double dt = step_s / steps, courant = speed_mps * dt / cell_m;
  const float nine = scheme.nine_share;
  const Program& program = near ? *programs.step_near : *programs.step;
  program.use();
  program.set("cells", cells);
  // Five points: 1 and -4; nine: (1 4 1; 4 -20 4; 1 4 1) / 6.
  program.set("laplacian", glm::vec4(1.0f - nine / 3.0f, nine / 6.0f, -4.0f + nine * (4.0f - 20.0f / 6.0f),
                                     static_cast<float>(courant * courant)));
  // The pull of the level is of a slow spring (0.5 rad/s): it holds the mean, which nothing else does, against
  // rounding.
  const double pull = scheme.quantised ? 0.0 : 0.25 * dt * dt;
  // w is what a step adds: of another step's length it is another number, or jitter would pump the waves up.
  const double ratio = last_step_s > 0.0 ? dt / last_step_s : 1.0;
  last_step_s = dt;
  const float lost = static_cast<float>(1.0 - std::exp(-2.0 * decay_per_s * dt));
  program.set("euler", int(scheme.euler));
  program.set("quantised", int(scheme.quantised));
  const int groups = (cells + RIPPLE_GROUP - 1) / RIPPLE_GROUP;
  for (int i = 0; i < steps; ++i) {
    // Seeds join after the tick's last step, so that at the tick they are as they were made.
    program.set("losses", glm::vec4(lost, pull, i == 0 ? ratio : 1.0, 0.0));
    program.set("shift", i == 0 ? shift : glm::ivec2(0));
    program.set("stamped", int(seed_count > 0 && i == steps - 1));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RIPPLE_STATE_BINDING, state.id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RIPPLE_NEXT_BINDING, next.id);
    glDispatchCompute(static_cast<GLuint>(groups), static_cast<GLuint>(groups), 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    std::swap(state, next);
  }
}

const RippleRun* RippleWaves::bring(const RipplePrograms& programs, const FrameRipples& frame,
                                    const RippleScheme& scheme, int cells, bool near) {
  const RippleTick* newest = frame.at(frame.tick);
  if (!newest || (near && !(newest->near_cell_m > 0.0f))) return nullptr;
  const std::int64_t since = near ? newest->near_since : 0;
  const auto begin = [&](std::int64_t tick) {
    return std::max(run_start(tick, since, frame.step_s), frame.first_tick());
  };
  std::array<RippleRun, 2>& runs = near ? near_ : shared_;
  const auto fits = [&](const RippleRun& r, std::int64_t start) {
    return r.begun && r.history == frame.history && r.start == start && r.since == since && r.tick <= frame.tick &&
           r.lattice.cells == cells && r.euler == scheme.euler;
  };
  const std::int64_t start = begin(frame.tick);
  if (!fits(runs[0], start) && fits(runs[1], start)) std::swap(runs[0], runs[1]);
  const bool goes_on = fits(runs[0], start);
  if (!goes_on) runs[0].begun = false;
  const std::int64_t stood = goes_on ? runs[0].tick : frame.tick;
  advance(programs, frame, scheme, cells, runs[0], near, start, since, frame.tick);
  // The next epoch's waves begin before it does.
  const auto memory = static_cast<std::int64_t>(std::llround(ripple_memory_s / frame.step_s));
  const std::int64_t next = begin(frame.tick + memory);
  if (next != start && next <= frame.tick) {
    if (!fits(runs[1], next)) runs[1].begun = false;
    // A frame that had to make up much leaves this to those after it. When it is done does not change what it is.
    const std::int64_t ticks = goes_on ? std::max<std::int64_t>(2 * (frame.tick - stood), 4) : 0;
    const std::int64_t stands = runs[1].begun ? runs[1].tick : next - 1;
    advance(programs, frame, scheme, cells, runs[1], near, next, since, std::min(frame.tick, stands + ticks));
  }
  return &runs[0];
}

void RippleWaves::advance(const RipplePrograms& programs, const FrameRipples& frame, const RippleScheme& scheme,
                          int cells, RippleRun& run, bool near, std::int64_t start, std::int64_t since,
                          std::int64_t until) {
  if (!run.begun) {
    run.lattice.rest(cells, near);
    run.history = frame.history;
    run.start = start;
    run.since = since;
    run.tick = start - 1;
    run.begun = true;
    run.euler = scheme.euler;
  }
  if (run.tick >= until) return;
  const std::int64_t first = run.tick + 1;
  const double shared_cell_m = frame.settings.tile_m / cells;
  RippleSettings settings = frame.settings;
  settings.seed_cells = seed_cells(settings, cells);
  // All ticks' seeds, in one upload.
  std::vector<RippleSeedGpu> seeds;
  std::vector<int> begins;
  std::vector<RippleImpact> landed;
  if (near) {
    // Ticks before the first known one have no rain.
    landed = drops_.impacts(frame, std::max(first, frame.first_tick() + 1), until, since, cells);
  }
  auto next_landed = landed.begin();
  for (std::int64_t tick = first; tick <= until; ++tick) {
    begins.push_back(static_cast<int>(seeds.size()));
    const RippleTick& t = *frame.at(tick);
    if (near) {
      const RippleTick& lies = *frame.at(std::max(tick, since));
      if (!(lies.near_cell_m > 0.0f)) continue;
      const double cell = lies.near_cell_m;
      const auto in_cells = [&](glm::dvec2 place) {
        return place / cell - glm::dvec2(lies.near_centre - cells / 2) - 0.5;
      };
      for (; next_landed != landed.end() && next_landed->tick <= tick; ++next_landed)
        if (next_landed->tick == tick)
          seeds.push_back(seed_of(*next_landed, in_cells(next_landed->place_m), cell, settings));
      for (const RippleWake& wake : t.wakes)
        seeds.push_back(seed_of(wake, in_cells(wake.place_m), cell, frame.settings.published));
    } else {
      for (const RippleImpact& i : shared_impacts(t, tick, frame.step_s, frame.settings.tile_m))
        seeds.push_back(seed_of(i, i.place_m / shared_cell_m - 0.5, shared_cell_m, settings));
    }
  }
  begins.push_back(static_cast<int>(seeds.size()));
  if (!seeds.empty()) upload(seeds_, std::span<const RippleSeedGpu>(seeds));
  for (std::int64_t tick = first; tick <= until; ++tick) {
    const auto i = static_cast<std::size_t>(tick - first);
    double cell = shared_cell_m;
    glm::ivec2 shift(0);
    if (near) {
      const RippleTick& lies = *frame.at(std::max(tick, since));
      cell = lies.near_cell_m;
      const RippleTick* before = tick > run.start ? frame.at(std::max(tick - 1, since)) : nullptr;
      if (before) shift = lies.near_centre - before->near_centre;
    }
    run.lattice.step(programs, scheme, frame.settings.wave_speed_mps, cell, frame.settings.decay_per_s, frame.step_s,
                     shift, seeds_, begins[i], begins[i + 1] - begins[i]);
    ++steps_;
  }
  run.tick = until;
}

std::size_t RippleWaves::bytes() const {
  std::size_t sum = seeds_.bytes;
  for (const auto* runs : {&shared_, &near_})
    for (const RippleRun& r : *runs) sum += r.lattice.state.bytes + r.lattice.next.bytes + r.lattice.stamps.bytes;
  return sum;
}

}  // namespace petrichor
