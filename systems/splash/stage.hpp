#pragma once
// A bare pavement under lamps for splashes: charts, benchmarks and tests stand on it. Needs a current OpenGL context.

#include <memory>
#include <vector>

#include "engine/gpu/timer.hpp"
#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/splash/splash.hpp"

namespace petrichor {

struct SplashStageSet {
  bool software = true;
  bool awning = false;    // a roof at 3 m over x from -2 to 2, z from -6 to -2
  bool unlimited = true;  // software OpenGL draws all that a GPU would
  float film_mm = 0.0f;   // of water on everything; 0: dry
  float roughness = 0.85f;
};

class SplashStage {
 public:
  static Result<std::unique_ptr<SplashStage>> make(const SplashStageSet&);
  // Eye 1.4 m above the ground at (x, z) = 0, looking along -z and a little down; two lamps ahead. No rain yet.
  Frame frame(int width, int height) const;
  Result<void> draw(Frame&);
  std::vector<float> light() const;  // rgb of all pixels, cd/m2, row 0 at the bottom
  FrameTimer& timer() { return timer_; }
  std::vector<PassReport> report() const { return graph_->report(); }
  std::vector<std::shared_ptr<const Model>> models() const { return {model_}; }

 private:
  explicit SplashStage(const SplashStageSet& set) : set_(set), timer_(set.software) {}
  Result<void> load();
  SplashStageSet set_;
  std::shared_ptr<const Model> model_;
  mutable GpuScene scene_;
  FrameGpu gpu_;
  FrameTimer timer_;
  ShaderLibrary shaders_;
  std::unique_ptr<Graph> graph_;
  const Texture* output_ = nullptr;
};

// Settings as by default.
std::shared_ptr<FrameSplashes> default_splashes();

}  // namespace petrichor
