#pragma once
// The director at work: between a World, a Renderer and the measured times (systems/director decides).

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
  // change needs them. After the first World::advance_to.
  Result<void> warm_up(Renderer&, World&, int width, int height);

  // Before World::extract: the techniques of this frame go to the world. step_s: since the frame before.
  void choose(World&, double step_s);
  // Whether this frame's passes are to be timed.
  bool profile() const { return output_.profile_next; }
  // After the frame: what it took (0: not known) and what its passes, or a recent frame's, took.
  void measured(const Frame&, double frame_ms, std::span<const Timing> passes);

  std::vector<DirectorNote> notes() const { return explain(director_); }
  nlohmann::json report() const;   // the notes
  nlohmann::json changes() const;  // every change of a rung

 private:
  Director director_;
  DirectorInput input_;
  DirectorOutput output_;
  Techniques asked_;
  std::vector<PassTime> passes_;
};

}  // namespace petrichor
