#pragma once
// The director at work: between a World, a Renderer and the measured times (systems/director decides).

#include <array>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/main/renderer.hpp"
#include "engine/main/world.hpp"
#include "systems/director/director.hpp"

namespace petrichor {

class Direction {
 public:
  // Reads content/ladders.csv where there is one. asked: what is drawn while the director rests.
  static Result<Direction> open(const Techniques& asked);

  double budget_ms = 0.0;  // 0: the director rests

  // Draws a frame by every rung that the director may choose, so that shaders are compiled and buffers made before a
  // change needs them. After World::advance_to(time_s); the frame extracted at time_s next is as if nothing had been.
  Result<void> warm_up(Renderer&, World&, double time_s, int width, int height);

  // World::extract of a frame for a picture of width x height, by the techniques that are chosen for what is in it.
  // step_s: since the frame before, as the viewer sees time.
  void extract(World&, Frame&, std::uint64_t number, double time_s, double step_s, int width, int height);
  // Whether this frame's passes are to be timed.
  bool profile() const { return output_.profile_next; }
  // After the frame: what it took (0: not known) and what its passes, or a recent frame's, took. gpu_times: those are
  // the GPU's own, beside which the rest of the frame is work of the CPU.
  void measured(double frame_ms, std::span<const Timing> passes, bool gpu_times);

  std::vector<DirectorNote> notes() const { return explain(director_); }
  nlohmann::json report() const;   // the notes
  nlohmann::json changes() const;  // every change of a rung

 private:
  Director director_;
  DirectorInput input_;
  DirectorOutput output_;
  Techniques asked_;
  std::vector<PassTime> passes_;
  bool left_out(World&, const Ladder&) const;
  void ask_of_what_is_left_out(World&, const std::function<void()>& extract_it, const Frame&);
  std::array<double, effect_count> coverage_left_out_{};
  std::int64_t frames_ = 0;
};

}  // namespace petrichor
