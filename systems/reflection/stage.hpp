#pragma once
// A bare street at night in which rungs are drawn, timed and compared with rays. For charts, benches and tests.

#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/core/result.hpp"
#include "engine/gpu/timer.hpp"
#include "engine/graph/graph.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/reflection/extract.hpp"

namespace petrichor {

using MakePasses = std::function<std::vector<PassOffer>()>;  // all passes; systems.cpp knows them

struct StageLook {
  glm::vec3 albedo{0.0f};
  float roughness = 1.0f;
  glm::vec3 emissive{0.0f};  // cd/m2
};
// A box in a material and a mesh of its own; only: 2 * axis + side, its one face there (a pane); -1: all six.
void add_lit_box(Model&, glm::vec3 low, glm::vec3 high, const StageLook&, int only = -1);

struct StageScene {
  std::string name, title;
  Model model;
  std::vector<FrameLight> lights;
  glm::vec3 eye{0.0f}, at{0.0f};
  float vertical_fov_rad = 0.9f;
};
FrameLight stage_lamp(glm::vec3 position_m, glm::vec3 intensity_cd);
// Level black ground of a roughness (all that is seen on it is mirrored), between matt walls with lit windows, lamps at
// 8, 16, 30 and 50 m, posts and bollards.
StageScene night_street(float roughness, float eye_m = 1.6f);

class ReflectionStage {
 public:
  // Needs a current context. parameters: of pass reflections.
  static Result<std::unique_ptr<ReflectionStage>> make(const MakePasses&, StageScene, int width, int height,
                                                       const std::map<std::string, double>& parameters = {});
  void look(glm::vec3 eye, glm::vec3 at);
  void use(ReflectionRung);
  // Linear light, cd/m2, rows from the bottom.
  Result<std::vector<glm::vec4>> draw();
  // Milliseconds of passes mirrors, reflections and reflections_over, by GPU timers, or by glFinish on software OpenGL.
  Result<double> time(bool software);
  std::vector<PassReport> report() const { return graph_->report(); }

  StageScene scene;
  Frame frame;

 private:
  std::vector<std::shared_ptr<const Model>> models_;
  ReflectorFinder finder_;
  ShaderLibrary shaders_;
  std::unique_ptr<Graph> graph_;
  GpuScene gpu_scene_;
  FrameGpu gpu_;
  Result<const Texture*> execute(FrameTimer&);
};

}  // namespace petrichor
