#pragma once
// A bare stage for wet surfaces: models, the G-buffer, the maps of shelter and the films over it, read back. Charts and
// tests use it. Needs a current OpenGL context.

#include <memory>
#include <span>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/core/result.hpp"
#include "engine/gpu/timer.hpp"
#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"

namespace petrichor {

struct WetPixels {
  int width = 0, height = 0;
  std::vector<float> depth;
  std::vector<glm::vec4> albedo, normal;  // as gbuffer.glsl stores them
  std::vector<glm::vec2> water;           // mm: standing, film
};

class WetStage {
 public:
  WetStage() = default;
  WetStage(const WetStage&) = delete;
  WetStage& operator=(const WetStage&) = delete;

  // Every mesh once, as it stands in the model.
  void add(std::shared_ptr<const Model>);
  // layers: of the maps of shelter.
  Result<void> load(std::vector<PassOffer> all, int layers);
  // Draws `frame` and reads it back.
  Result<WetPixels> draw();
  // Milliseconds of pass wet_surfaces in so many frames.
  Result<std::vector<double>> time(int frames, bool software);
  bool ran() const;  // whether wet_surfaces ran in the last frame
  std::span<const Model* const> models() const { return pointers_; }

  Frame frame;  // instances are the stage's; camera, weather and rungs the caller's
 private:
  Result<void> execute(FrameTimer&);

  GpuScene scene_;
  FrameGpu gpu_;
  ShaderLibrary shaders_;
  std::unique_ptr<Graph> graph_;
  std::vector<std::shared_ptr<const Model>> models_;
  std::vector<const Model*> pointers_;
  WetPixels pixels_;
  bool reads_ = true;
};

}  // namespace petrichor
