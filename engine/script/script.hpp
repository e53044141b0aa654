#pragma once
// Lua 5.4 in a sandbox: scenes spawn entities and set components through bindings made from schemas, and
// a timeline of coroutines directs them in simulation time. docs/reference.md is what users read.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/ecs/registry.hpp"
#include "engine/ecs/schema.hpp"

namespace petrichor {

// What a script may use before it is stopped with an error that it cannot catch. Instructions are those of
// the Lua machine; library calls on large data count as many. The clock is a backstop only: it never
// decides what a script does, just that one which has hung is stopped.
struct ScriptLimits {
  std::size_t memory_bytes = std::size_t{256} << 20;
  std::uint64_t load_instructions = 200'000'000;  // run_file, read_table
  std::uint64_t step_instructions = 50'000'000;   // one advance
  double wall_s = 20.0;                           // one call of any of them
  // What lives outside Lua's own memory.
  std::size_t entities = 250'000;
  std::size_t models = 1000;
  std::size_t text_bytes = 4096;  // of one text field
  std::size_t handlers = 10'000;
};

// What scripts can ask for that is not a component. A function that is not set is an error when called.
struct ScriptServices {
  // Spawns a model's nodes and returns their entities, parents first.
  std::function<Result<std::vector<Entity>>(const std::filesystem::path&)> load_model;
  // World-space box of what the entities draw, in metres; an error where they draw nothing.
  std::function<Result<std::pair<glm::vec3, glm::vec3>>(std::span<const Entity>)> bounds;
  std::function<Result<void>(Entity child, Entity parent)> set_parent;
  // One line of print(); the log where not set.
  std::function<void(std::string_view)> print;
};

// The few fields that the language itself speaks of: world.find, camera.path. "component.field".
struct ScriptNames {
  std::string name = "name.text";
  std::string position = "transform.position_m";
  std::string orientation = "transform.orientation";
  std::string field_of_view = "camera.vertical_fov_deg";
  std::string camera_active = "camera.active";
};

struct ScriptOptions {
  std::vector<std::filesystem::path> roots;  // folders that `require` looks in, in order
  ScriptLimits limits;
  std::uint64_t seed = 1;                                      // of math.random
  std::vector<std::pair<std::string, std::string>> arguments;  // the global table `args`
  ScriptServices services;
  ScriptNames names;
};

// What cinematic{...} declared; a field that was not given keeps its nullopt.
struct Cinematic {
  std::optional<double> duration_s;
  std::optional<double> fps;
  std::optional<glm::ivec2> size_px;
  std::optional<std::string> render;  // the frame's script
};

// One script world: a registry directed by one or more files. All calls on one thread. Errors carry
// file:line and a traceback.
class ScriptHost {
 public:
  // The registry and the schemas outlive the host.
  ScriptHost(Registry&, std::span<const Schema>, ScriptOptions);
  ~ScriptHost();
  ScriptHost(ScriptHost&&) noexcept;
  ScriptHost& operator=(ScriptHost&&) noexcept;

  // Runs a file up to its end or its first wait. Its timelines begin with the first advance, so call
  // advance(0) before the first frame. After an error the host can be destroyed or go on.
  Result<void> run_file(const std::filesystem::path&);

  // Brings the timeline to simulation time time_s (never earlier than before): resumes every coroutine that
  // is due, by (wake time, creation order), each at the very time it asked for, then evaluates tweens and
  // paths at time_s. The state after it does not depend on the size of the steps. A coroutine that fails
  // ends; the others go on, and the errors come back together.
  Result<void> advance(double time_s);

  // Tells on(event, ...) and wait_for(event) in the next advance, at its time. `argument` reaches them as a Lua
  // value unless it is null.
  void emit(std::string_view event, const nlohmann::json& argument);
  void emit(std::string_view event);

  // From now on this field holds this value wherever a script spawns, sets or tweens it (--set). Entities
  // that have the component are set at once.
  Result<void> pin(std::string_view component, std::string_view field, const nlohmann::json& value);

  const Cinematic& cinematic() const;
  std::optional<double> duration_s() const;
  // Whether any coroutine, tween or path is still to come.
  bool busy() const;
  // Every file that was read, for hot reload; those that could not be read or compiled as well.
  const std::vector<std::filesystem::path>& files() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

// Runs a file that returns a table, in a sandbox of its own without world or timeline, and gives the table as
// JSON. A table whose keys are 1..n becomes an array; any other, an empty one too, an object, in which
// integer keys turn into their digits. Functions, NaN, cycles, more than 64 levels or 200,000 values are
// errors that name the place. `files`, where given, receives what was read, also on failure.
Result<nlohmann::json> read_table(const std::filesystem::path&, const ScriptOptions&,
                                  std::vector<std::filesystem::path>* files = nullptr);

}  // namespace petrichor
