#pragma once
// What every system is handed: the components, the time, and for extraction the Frame to fill.

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/core/result.hpp"
#include "engine/ecs/commands.hpp"
#include "engine/ecs/registry.hpp"
#include "systems/frame.hpp"

namespace petrichor {

class CollisionScene;  // systems/walker/collision.hpp

// What the person in the sandbox wants this tick; all at rest where there is no person.
struct PlayerInput {
  bool forward = false, back = false, left = false, right = false;
  bool up = false, down = false;  // flying; up jumps when walking
  bool run = false;
  bool toggle_flying = false;
  float turn_right_deg = 0.0f, turn_up_deg = 0.0f;
};

struct SystemContext {
  Registry& registry;
  Commands& commands;
  double time_s = 0.0;  // of the tick; of the frame in the extract phase
  double step_s = 1.0 / 120.0;
  double interpolation = 1.0;  // extract: where the frame stands between the last two ticks, 1: at the newer
  PlayerInput input;
  const std::vector<std::shared_ptr<const Model>>& models;  // MeshInstance::model is an index here
  CollisionScene* collision = nullptr;                      // where somebody walks
  std::function<Result<void>(double time_s)> advance_script;
  Result<void> script_result;  // of the last tick
  Frame* frame = nullptr;      // extract only
};

}  // namespace petrichor
