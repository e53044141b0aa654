#pragma once
// A bare stage for the rain: an even wall or darkness, lamps, the rain's own passes, and nothing else. Charts,
// benchmarks and tests use it. Needs a current OpenGL context.

#include <memory>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/timer.hpp"
#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"
#include "systems/frame_gpu.hpp"

namespace petrichor {

struct StageSet {
  glm::vec3 wall_cd_m2{0.0f};
  float wall_distance_m = 0.0f;  // 0: no wall and no fog, an empty scene
  bool fog = true;               // the wall is seen through what stands in for undrawn rain
  bool wall_hides = false;       // the wall is in the depth buffer
  bool map = false;              // there is an occlusion map, of
  float roof_m = 0.0f;           // a roof this high above the camera over all places with x < 0, relative; 0: no roof
  bool present = true;           // also make the 8-bit picture
  int path = 0;                  // of rain_cells: how drops are drawn
  bool flakes = false;           // what stands in for undrawn rain is snow: the lamps' light by the flakes' phase
  int layered_shells = 0;        // of layered_composite: 3 or 4; 0 by the device
  bool draw_rain = true;         // false: the backdrop alone
};

class RainStage {
 public:
  // Errors are those of the shaders.
  static Result<std::unique_ptr<RainStage>> make(bool software_gl, const StageSet&);

  // Finishes, uploads and draws the frame. frame.rain is drawn as it stands.
  Result<void> draw(Frame&);
  // After draw, without present: linear light, cd/m2, rgba, row 0 at the bottom.
  std::vector<float> read_light() const;
  std::vector<unsigned char> read_picture() const;  // rgba; only with present
  FrameTimer& timer() { return timer_; }
  std::vector<PassReport> report() const { return graph_->report(); }

 private:
  explicit RainStage(bool software_gl, const StageSet& set) : set_(set), timer_(software_gl) {}
  Result<void> load();

  StageSet set_;
  ShaderLibrary library_;
  std::unique_ptr<Graph> graph_;
  FrameTimer timer_;
  FrameGpu frame_gpu_;
  const Texture* output_ = nullptr;
};

// A frame with a camera at the origin (or elsewhere) looking along -z, night sky, no rain yet.
Frame stage_frame(int width, int height, const glm::dvec3& camera_m = glm::dvec3(0.0));

}  // namespace petrichor
