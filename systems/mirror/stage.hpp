#pragma once
// A bare stage for mirrors and probes: the passes that they need of all that are given, and questions about places.
// Charts and tests use it. Needs a current OpenGL context.

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/core/result.hpp"
#include "engine/gpu/timer.hpp"
#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"

namespace petrichor {

struct MirrorQuestion {
  glm::vec3 place_m{0.0f};  // world
  glm::vec3 normal{0.0f, 1.0f, 0.0f};
  glm::vec3 direction{0.0f, 1.0f, 0.0f};  // of the mirrored ray
  float roughness = 0.04f;
};

struct MirrorAnswer {
  glm::vec4 mirror, probe, endless_probe, environment;  // mirror_ask.comp.glsl
};

class MirrorStage {
 public:
  // Passes of the geometry, the lighting and the mirrors, and more if need be. Errors are those of table and shaders.
  // scale: of the mirrors' resource. lit_picture: passes shade and glass run too, and texture("colour") has what they
  // drew.
  static Result<std::unique_ptr<MirrorStage>> make(std::vector<PassOffer> passes, bool software, double scale = 0.5,
                                                   const std::map<std::string, double>& mirrors_parameters = {},
                                                   const std::map<std::string, double>& probes_parameters = {},
                                                   bool lit_picture = false);
  MirrorStage(const MirrorStage&) = delete;
  MirrorStage& operator=(const MirrorStage&) = delete;

  std::uint32_t add(const Model&);  // index for frame.instances
  // Draws the frame and asks. An empty list only draws.
  Result<std::vector<MirrorAnswer>> ask(const std::vector<MirrorQuestion>&);
  // Milliseconds of a pass in the last frame that was drawn; 0: it did not run.
  double milliseconds(std::string_view pass) const;
  bool ran(std::string_view pass) const;
  // "mirrors", "probes" or "colour" as half floats, all layers of level 0; empty: not drawn.
  std::vector<std::uint16_t> texture(std::string_view resource) const;
  glm::ivec2 mirrors_size() const { return mirrors_size_; }

  Frame frame;  // instances, lights, mirrors are the caller's

 private:
  MirrorStage(std::vector<PassOffer> passes, bool software);

  GpuScene scene_;
  FrameGpu gpu_;
  FrameTimer timer_;
  ShaderLibrary shaders_;
  std::unique_ptr<Graph> graph_;
  std::vector<glm::vec4> asked_;
  std::size_t asked_count_ = 0;
  Buffer questions_, answers_;
  std::vector<Timing> timings_;
  GLuint mirrors_ = 0, probes_ = 0, colour_ = 0;
  glm::ivec2 mirrors_size_{0};
};

}  // namespace petrichor
