#pragma once
// Simulation runs on a fixed step counted by an integer tick; rendering interpolates between ticks.
// After Fiedler, "Fix Your Timestep!" (2004), with the accumulator bounded.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace petrichor {

struct FixedClock {
  double step_s = 1.0 / 60.0;
  int most_steps = 8;      // per advance(): beyond it time is dropped, so that slow steps cannot pile up
  std::int64_t tick = 0;   // steps taken
  double left_over_s = 0;  // real time not yet simulated, in [0, step_s)
  double dropped_s = 0;    // real time given up so far
};

// Simulated time in seconds: a product, not a sum, so tick 900 is the same however it was reached.
inline double simulated_s(const FixedClock& clock) {
  return static_cast<double>(clock.tick) * clock.step_s;
}

// Where the picture stands between the last two ticks, in [0, 1): 0 shows the older one.
inline double interpolation(const FixedClock& clock) {
  return std::clamp(clock.left_over_s / clock.step_s, 0.0, std::nextafter(1.0, 0.0));
}

// Real time passed; returns how many steps are to be simulated now. Call step() after each.
// Negative and non-finite times count as none.
inline int advance(FixedClock& clock, double real_s) {
  assert(clock.step_s > 0.0 && clock.most_steps > 0);
  if (!(real_s > 0.0) || !std::isfinite(real_s)) return 0;
  clock.left_over_s += real_s;
  // A display at the step's own rate must give one step a frame, not none and then two, whatever the
  // last bit of the sum.
  const double due = std::floor(clock.left_over_s / clock.step_s + 1e-9);
  clock.left_over_s = std::max(0.0, clock.left_over_s - due * clock.step_s);
  const double steps = std::min(due, static_cast<double>(clock.most_steps));
  clock.dropped_s += (due - steps) * clock.step_s;
  return static_cast<int>(steps);
}

// Counts one simulated step.
inline void step(FixedClock& clock) {
  ++clock.tick;
}

}  // namespace petrichor
