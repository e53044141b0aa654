#pragma once
// A running scene: the registry, the script that directs it and the fixed-step simulation. Knows nothing of
// windows or images; fills a Frame when asked.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "engine/app/options.hpp"
#include "engine/core/result.hpp"
#include "engine/ecs/schedule.hpp"
#include "engine/script/script.hpp"
#include "systems/system_context.hpp"
#include "systems/systems.hpp"
#include "systems/walker/collision.hpp"

namespace petrichor {

inline constexpr double simulation_step_s = 1.0 / 120.0;

class World {
 public:
  // Runs the subject's script (a model gets scripts/scenes/model.lua) and applies --set and --technique.
  // Models are uploaded to `scene` unless it is null (no GL at all).
  static Result<std::unique_ptr<World>> open(const SubjectOptions&, GpuScene* scene);

  // Simulates up to the first tick at or after time_s. `input` is what the person did since the last call.
  Result<void> advance_to(double time_s, const PlayerInput& input = {});
  // The state at time_s (at most one tick before the newest), for frame `number` of width x height pixels. Again at the
  // same time it is the same, but for what techniques() and the size change.
  void extract(Frame&, std::uint64_t number, double time_s, int width, int height);
  // The budget of drops for emitters that name none. Part of the picture: the same on every run on a device.
  void set_affordable_drops(std::int32_t drops) { affordable_drops_ = drops; }

  // By what each effect is drawn; --technique has set some of them for good.
  Techniques& techniques() { return techniques_; }
  bool chosen_by_user(Effect effect) const { return chosen_by_user_[static_cast<std::size_t>(effect)]; }

  Registry& registry() { return registry_; }
  ScriptHost& script() { return *script_; }
  const Cinematic& cinematic() const { return script_->cinematic(); }
  std::filesystem::path render_script() const;
  const std::vector<std::filesystem::path>& script_files() const { return script_->files(); }
  std::span<const SystemStats> system_stats() const { return schedule_.stats(); }
  std::uint32_t seed() const { return seed_; }

 private:
  World(GpuScene* scene, std::uint32_t seed);
  Result<std::vector<Entity>> spawn(const std::filesystem::path& file);
  Result<void> apply_options(const SubjectOptions&);
  SystemContext context();
  bool has_camera();
  bool has_walker();

  Registry registry_;
  Commands commands_{registry_};
  Schedule<SystemContext> schedule_;
  std::vector<std::shared_ptr<const Model>> models_;
  std::unique_ptr<CollisionScene> collision_;
  std::size_t collision_models_ = 0;  // that many models were there when it was made
  std::unique_ptr<ScriptHost> script_;
  GpuScene* scene_;
  std::uint32_t seed_;
  std::int32_t affordable_drops_ = 4000000;
  Techniques techniques_;
  std::array<bool, effect_count> chosen_by_user_{};
  double extracted_s_ = -1.0;      // time of the newest frame
  float step_s_ = Frame{}.step_s;  // from the frame before to it
  bool told_of_no_camera_ = false;
  std::int64_t tick_ = -1;  // the newest simulated tick
};

}  // namespace petrichor
