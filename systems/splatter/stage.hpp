#pragma once
// A bare stage for splatter and halos: a few marked shapes, a lamp or two, and the two passes over an even picture.
// Charts, benchmarks and tests use it. Needs a current OpenGL context.

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "components/weather.hpp"
#include "engine/assets/model.hpp"
#include "engine/core/result.hpp"
#include "engine/gpu/timer.hpp"
#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/splatter_frame.hpp"

namespace petrichor {

// A box, and a rounded car-like body: one mesh each, ground at y = 0, its front along +z.
Model box_model(const glm::vec3& half_m, float bottom_m);
Model body_model(int around = 28, int along = 24);

// Rain in still air, from the sizes alone.
FrameRain still_rain(float rain_mm_per_hour, std::uint32_t seed = 1);

class SplatterStage {
 public:
  // more: passes of others, at the front of the table as {"pass", slot, resource}; say the maps of shelter.
  static Result<std::unique_ptr<SplatterStage>> make(bool software_gl, std::vector<PassOffer> more = {});

  // Adds a model and one instance of it, marked or not; returns the instance's index. Matrices may be changed later.
  std::size_t add(const Model&, const glm::mat4&, bool marked = true);
  // Fills frame.splatter from the marks and frame.rain, and draws. frame.camera, lights, techniques are the caller's.
  Result<void> draw();
  // Draws so many frames and gives milliseconds of a pass.
  Result<std::vector<double>> time(std::string_view pass, int frames);
  std::vector<float> read_light() const;  // rgba, cd/m2, row 0 at the bottom
  // Axial metres of what stands in each pixel; infinite where there is nothing.
  std::vector<float> read_distances() const;
  std::vector<glm::vec3> read_normals() const;  // world, of those pixels
  std::vector<PassReport> report() const { return graph_->report(); }

  Frame frame;
  std::vector<Catcher> marks;  // as add() made them: change their settings
  glm::vec3 background_cd_m2{0.0f};
  int steps = 0;   // of the layer; 0: by the device
  int shells = 0;  // of splatter; 0: as the marks say, or fewer by the device

 private:
  explicit SplatterStage(bool software_gl) : timer_(software_gl) {}
  ShaderLibrary library_;
  std::unique_ptr<Graph> graph_;
  FrameTimer timer_;
  FrameGpu gpu_;
  GpuScene scene_;
  std::vector<std::shared_ptr<const Model>> models_;
  const Texture* output_ = nullptr;
  GLuint depth_ = 0, normal_ = 0;
  nlohmann::json table_;
  int loaded_steps_ = -1, loaded_shells_ = -1;
};

void look(FrameCamera&, const glm::vec3& from_m, const glm::vec3& at_m, float fov_deg);

}  // namespace petrichor
