#pragma once
// A bare stage for drips: an edge before a wall and lamps, under a night sky, and the drips' own passes. Charts,
// benchmarks and tests use it. Needs a current OpenGL context.

#include <memory>
#include <vector>

#include "components/water.hpp"
#include "engine/core/result.hpp"
#include "engine/gpu/timer.hpp"
#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"
#include "systems/frame_gpu.hpp"

namespace petrichor {

// An edge along x, 3 m over a floor, seen from a little below; two lamps stand behind it.
struct DripSet {
  DripSource source;
  float rain_mm_per_hour = 20.0f;
  float camera_away_m = 2.0f;
  float shows_world_px = 0.5f;  // FrameDrips::shows_world_px
  int rows = 1;                 // such edges, one behind the other
  glm::vec3 wall_cd_m2{0.3f};
};

class DripStage {
 public:
  // Errors are those of the shaders.
  static Result<std::unique_ptr<DripStage>> make(bool software_gl);

  // The set's drips at a time, and everything about them.
  Frame frame(const DripSet&, int width, int height, double time_s, std::size_t most_drips) const;
  Result<void> draw(Frame&);
  std::vector<float> read_light() const;  // luminance, cd/m2, row 0 at the bottom
  // Milliseconds of the drips' own passes (drips, drips_over) in a frame.
  Result<double> time(Frame&);
  std::vector<PassReport> report() const { return graph_->report(); }

 private:
  explicit DripStage(bool software_gl) : timer_(software_gl) {}

  ShaderLibrary library_;
  std::unique_ptr<Graph> graph_;
  FrameTimer timer_;
  FrameGpu frame_gpu_;
  const Texture* output_ = nullptr;
};

}  // namespace petrichor
