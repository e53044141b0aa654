#pragma once
// A bare stage for shelter: models, the maps' own pass, and questions about places. Charts and tests use it. Needs a
// current OpenGL context.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/core/result.hpp"
#include "engine/gpu/timer.hpp"
#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/occlusion/rays.hpp"

namespace petrichor {

struct ShelterQuestion {
  glm::vec3 place_m;  // world
  glm::vec3 normal{0.0f, 1.0f, 0.0f};
  glm::vec3 velocity_mps{0.0f, -1.0f, 0.0f};
};

// What occlusion.glsl says of it.
struct ShelterAnswer {
  float first_hit_m;        // along the mean fall
  bool sheltered;           // along the mean fall
  bool sheltered_velocity;  // along the velocity asked about
  float shelter, shelter_normal, deposit;
  float first_hit_velocity_m;
};

struct ShelterCost {
  std::vector<double> maps_ms;   // to redraw all maps of the frame
  std::vector<double> query_ns;  // of all that can be asked together, a place
};

class OcclusionStage {
 public:
  OcclusionStage() = default;
  OcclusionStage(const OcclusionStage&) = delete;
  OcclusionStage& operator=(const OcclusionStage&) = delete;

  std::uint32_t add(std::shared_ptr<const Model>);  // index for frame.instances
  // Every mesh once, as it stands in its model.
  std::uint32_t add_placed(std::shared_ptr<const Model>);
  // Errors are those of the table and the shaders. Parameters are those of occlusion_map.
  Result<void> load(int texels, int layers, const std::map<std::string, double>& parameters = {});
  Result<std::vector<ShelterAnswer>> ask(const std::vector<ShelterQuestion>&);
  // Draws the maps again with everything stale, so many times. Questions as in ask().
  Result<ShelterCost> time(const std::vector<ShelterQuestion>&, int repeats);
  ShelterRays rays() const;

  Frame frame;  // instances and weather are the caller's; camera at the origin
  GLuint map_texture() const { return map_; }
  int redrawn() const { return redrawn_; }  // maps, by the last question

 private:
  Result<void> draw();

  GpuScene scene_;
  FrameGpu gpu_;
  FrameTimer timer_{true};
  ShaderLibrary shaders_;
  std::unique_ptr<Graph> graph_;
  std::vector<std::shared_ptr<const Model>> models_;
  std::vector<glm::vec4> asked_;
  std::size_t asked_count_ = 0;
  Buffer questions_, answers_;
  GLuint map_ = 0;
  int redrawn_ = 0;
  double maps_ms_ = 0.0, query_ms_ = 0.0;
};

}  // namespace petrichor
