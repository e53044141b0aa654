#pragma once
// A bare stage for puddles: their own pass and questions about places. The chart and tests use it. Needs a current
// OpenGL context.

#include <memory>
#include <vector>

#include "engine/gpu/timer.hpp"
#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/puddle_frame.hpp"
#include "systems/wet_material_shared.h"

namespace petrichor {

struct PuddleQuestion {
  glm::vec3 place_m;  // world
  glm::vec2 mask;     // as in the G-buffer's water_mask; g is the kind / 255
};

// What puddle.glsl says of it.
struct PuddleAnswer {
  float depth_m, influence, ripple_scale, ripple_turn_rad;
  glm::vec3 tint;
};

class PuddleStage {
 public:
  PuddleStage() = default;
  PuddleStage(const PuddleStage&) = delete;
  PuddleStage& operator=(const PuddleStage&) = delete;

  Result<void> load();
  // Empty where the pass did not run.
  Result<std::vector<PuddleAnswer>> ask(const std::vector<PuddleQuestion>&);
  double pass_ms() const { return pass_ms_; }    // of the last questions: the list,
  double query_ms() const { return query_ms_; }  // and all places
  bool ran() const { return ran_; }

  Frame frame;
  std::vector<WetMaterialGpu> kinds;  // by kind; the first never gets wet

 private:
  FrameGpu gpu_;
  FrameTimer timer_{true};
  ShaderLibrary shaders_;
  std::unique_ptr<Graph> graph_;
  std::size_t asked_ = 0;
  Buffer questions_, answers_, kinds_;
  bool ran_ = false;
  double pass_ms_ = 0.0, query_ms_ = 0.0;
};

}  // namespace petrichor
