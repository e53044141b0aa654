#pragma once
// A bare stage for ripples: a puddle, rain, an eye, the pass alone and its textures read back. Charts, benches and
// tests use it. Needs a current OpenGL context.

#include <memory>
#include <vector>

#include "components/water.hpp"
#include "components/weather.hpp"
#include "engine/core/result.hpp"
#include "engine/ecs/registry.hpp"
#include "engine/gpu/timer.hpp"
#include "engine/graph/graph.hpp"
#include "systems/drip_frame.hpp"
#include "systems/frame.hpp"
#include "systems/frame_gpu.hpp"

namespace petrichor {

class RippleStage {
 public:
  RippleStage();
  RippleStage(const RippleStage&) = delete;
  RippleStage& operator=(const RippleStage&) = delete;

  // Errors are those of the table and the shaders.
  Result<void> load(int cells, int layers = 3, double rings = 0.0);
  // The world: changes count from the next tick on.
  Emitter& emitter();
  Wind& wind();
  Ripples& ripples();
  Entity add_wader(const Wader&, glm::vec3 place_m);
  void place(Entity, glm::vec3 place_m);
  // The eye: where it is, which way it looks (unit).
  void look(glm::dvec3 from_m, glm::vec3 ahead);
  // One tick of the fixed clock, 1/120 s.
  void tick();
  void run(double seconds);
  std::int64_t ticks() const { return ticks_; }
  // What extract makes of it: `before` of a tick earlier than the newest.
  Frame frame(double before = 0.0) const;
  // Draws; waits for its end. Returns the milliseconds that it took, those of the GPU's clock where that is real.
  Result<double> draw(Frame);
  // Of the last draw.
  std::vector<glm::vec4> layer(int layer) const;
  int cells() const { return cells_; }
  // What ripple.glsl says of places (relative to the camera; w: share of the rain that is let through) at the next
  // draw: slope x and z, variance.
  std::vector<glm::vec4> questions;
  std::vector<glm::vec4> answers() const;
  bool ran() const { return ran_; }

  Techniques techniques;
  bool software = true;
  std::vector<DripLanding> landings;  // of every frame

 private:
  Registry registry_;
  Entity rain_, eye_, puddle_;
  std::int64_t ticks_ = 0;
  int cells_ = 0;
  FrameGpu gpu_;
  std::unique_ptr<FrameTimer> timer_;
  ShaderLibrary shaders_;
  std::unique_ptr<Graph> graph_;
  GLuint map_ = 0;
  Buffer questions_, answers_;
  int layers_ = 0;
  bool ran_ = false;
  std::uint64_t number_ = 0;
};

}  // namespace petrichor
