#include "engine/main/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "components/components.hpp"
#include "engine/core/log.hpp"
#include "engine/core/paths.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/rainfall/streaks/gpu.hpp"
#include "systems/scene/propagate.hpp"
#include "systems/scene/spawn.hpp"
#include "systems/wet_materials.hpp"

namespace petrichor {
namespace {

namespace fs = std::filesystem;

bool is_model(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".gltf" || extension == ".glb";
}

// A path of a script or of the command line: as given, else among the program's own files.
Result<fs::path> find_file(const fs::path& file) {
  std::error_code ignored;
  if (fs::exists(file, ignored)) return fs::absolute(file);
  auto found = find_data(file);
  if (!found && file.is_relative())
    return failure(fmt::format("{} is neither here, in {}, nor among the program's files: {}", file.string(),
                               fs::current_path(ignored).string(), found.error().message));
  return found;
}

// "component.field=value": numbers, true/false and [x, y, z] are JSON; "x,y,z" is a vector; the rest is text.
nlohmann::json parse_value(const std::string& text) {
  auto value = nlohmann::json::parse(text, nullptr, false);
  if (!value.is_discarded() && !value.is_object()) return value;
  if (text.find(',') != std::string::npos) {
    value = nlohmann::json::parse("[" + text + "]", nullptr, false);
    if (!value.is_discarded()) return value;
  }
  return text;
}

Result<std::pair<glm::vec3, glm::vec3>> bounds_of(Registry& registry,
                                                  const std::vector<std::shared_ptr<const Model>>& models,
                                                  std::span<const Entity> entities) {
  propagate_transforms(registry);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  glm::vec3 low(infinity), high(-infinity);
  for (const Entity entity : entities) {
    const auto* instance = registry.find<MeshInstance>(entity);
    const auto* placed = registry.find<WorldTransform>(entity);
    if (!instance || !placed || instance->model >= models.size()) continue;
    const Model& model = *models[instance->model];
    if (instance->mesh >= model.meshes.size()) continue;
    for (const Primitive& primitive : model.meshes[instance->mesh].primitives)
      for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 at(corner & 1 ? primitive.bounds_max_m.x : primitive.bounds_min_m.x,
                           corner & 2 ? primitive.bounds_max_m.y : primitive.bounds_min_m.y,
                           corner & 4 ? primitive.bounds_max_m.z : primitive.bounds_min_m.z);
        const glm::vec3 world = placed->matrix * glm::vec4(at, 1.0f);
        low = glm::min(low, world);
        high = glm::max(high, world);
      }
  }
  if (!(low.x <= high.x)) return failure("these entities draw nothing, so they have no bounds");
  return std::pair{low, high};
}

// Every emitter has the settings of all techniques, so that --set, scripts and the inspector find them.
void give_techniques(Registry& registry) {
  std::vector<Entity> emitters;
  registry.view<const Emitter>().each([&](Entity entity, const Emitter&) { emitters.push_back(entity); });
  bool snows = false;
  registry.view<const Snowfall>().each([&](Entity, const Snowfall&) { snows = true; });
  for (const Entity entity : emitters) {
    if (!registry.find<DoubleCone>(entity)) registry.emplace<DoubleCone>(entity);
    if (!registry.find<LayeredComposite>(entity)) registry.emplace<LayeredComposite>(entity);
    if (!registry.find<StreakSprites>(entity)) registry.emplace<StreakSprites>(entity);
    if (!registry.find<NearDrops>(entity)) registry.emplace<NearDrops>(entity);
    if (!registry.find<WetGround>(entity)) registry.emplace<WetGround>(entity);
    if (!registry.find<Splashes>(entity)) registry.emplace<Splashes>(entity);
    if (!registry.find<Ripples>(entity)) registry.emplace<Ripples>(entity);
    if (!snows) registry.emplace<Snowfall>(entity);
  }
}

}  // namespace

World::World(GpuScene* scene, std::uint32_t seed)
    : schedule_(all_systems(), component_schemas()), scene_(scene), seed_(seed) {}

Result<std::vector<Entity>> World::spawn(const fs::path& file) {
  const auto found = find_file(file);
  if (!found) return tl::unexpected(found.error());
  auto loaded = load_model(*found);
  if (!loaded) return tl::unexpected(loaded.error());
  for (const std::string& warning : loaded->warnings) log_warn("{}", warning);
  auto model = std::make_shared<Model>(std::move(*loaded));
  const auto index = static_cast<std::uint32_t>(models_.size());
  if (auto water = read_material_water(*model); !water) return tl::unexpected(water.error());
  if (scene_) scene_->add(*model);
  // Pixels are on the GPU now; a city's worth of them need not stay here too.
  for (Image& image : model->images) image.pixels = {};
  models_.push_back(model);
  return spawn_model(registry_, *model, index);
}

Result<std::unique_ptr<World>> World::open(const SubjectOptions& options, GpuScene* scene) {
  const auto subject = find_file(options.subject);
  if (!subject) return tl::unexpected(subject.error());
  std::unique_ptr<World> world(new World(scene, options.seed));

  ScriptOptions script;
  for (const fs::path& root : data_roots())
    if (std::error_code ignored; fs::is_directory(root / "scripts", ignored)) script.roots.push_back(root / "scripts");
  script.seed = options.seed;
  World* self = world.get();
  script.services.load_model = [self](const fs::path& file) { return self->spawn(file); };
  script.services.bounds = [self](std::span<const Entity> entities) {
    return bounds_of(self->registry_, self->models_, entities);
  };
  script.services.set_parent = [self](Entity child, Entity parent) -> Result<void> {
    self->registry_.emplace_or_replace<Parent>(child, Parent{parent});
    return {};
  };

  Result<fs::path> file = *subject;
  if (is_model(*subject)) {
    script.arguments.emplace_back("model", subject->string());
    file = find_data("scripts/scenes/model.lua");
    if (!file) return tl::unexpected(file.error());
  }
  world->script_ = std::make_unique<ScriptHost>(world->registry_, component_schemas(), std::move(script));
  if (auto ran = world->script_->run_file(*file); !ran) return tl::unexpected(ran.error());
  give_techniques(world->registry_);
  if (auto applied = world->apply_options(options); !applied) return tl::unexpected(applied.error());
  if (auto first = world->advance_to(0.0); !first) return tl::unexpected(first.error());
  return world;
}

Result<void> World::apply_options(const SubjectOptions& options) {
  registry_.view<Emitter>().each([&](Entity, Emitter& emitter) { emitter.seed ^= (options.seed - 1) * 0x9e3779b9u; });
  registry_.view<Snowfall>().each([&](Entity, Snowfall& snow) { snow.seed ^= (options.seed - 1) * 0x9e3779b9u; });
  for (const std::string& text : options.sets) {
    const auto equals = text.find('=');
    const std::string target = text.substr(0, equals);
    const auto dot = target.find('.');
    if (dot == std::string::npos) return wrong_call(fmt::format("--set {}: expected component.field=value", text));
    if (auto pinned = script_->pin(target.substr(0, dot), target.substr(dot + 1), parse_value(text.substr(equals + 1)));
        !pinned)
      return wrong_call(fmt::format("--set {}: {}", text, pinned.error().message));
  }
  for (const std::string& text : options.techniques) {
    const auto equals = text.find('=');
    const std::string effect = text.substr(0, equals), rung = text.substr(equals + 1);
    std::string known;
    bool found = false;
    for (const Ladder& ladder : all_ladders())
      for (std::size_t i = 0; i < ladder.rungs.size(); ++i) {
        known += fmt::format("\n  {}={}  {}", ladder.name, ladder.rungs[i].name, ladder.rungs[i].meaning);
        if (ladder.name != effect || ladder.rungs[i].name != rung) continue;
        found = true;
        techniques_.set(ladder.effect, static_cast<std::uint8_t>(i));
        chosen_by_user_[static_cast<std::size_t>(ladder.effect)] = true;
      }
    if (!found) return wrong_call(fmt::format("--technique {}: no such technique. There are:{}", text, known));
  }
  // Needed unless streaks are even.
  if (techniques_[Effect::streaks].rung != static_cast<std::uint8_t>(StreakRung::even))
    if (auto table = shared_streak_table(); !table) return tl::unexpected(table.error());
  return {};
}

SystemContext World::context() {
  SystemContext context{registry_, commands_, 0.0, simulation_step_s, 1.0, {}, models_};
  context.collision = collision_.get();
  context.advance_script = [this](double time_s) { return script_->advance(time_s); };
  return context;
}

Result<void> World::advance_to(double time_s, const PlayerInput& input) {
  // The tolerance keeps frame times that are whole ticks, but for rounding, at their tick.
  const auto last = static_cast<std::int64_t>(std::ceil(time_s / simulation_step_s - 1e-6));
  if (has_walker() && (!collision_ || collision_models_ != models_.size())) {
    propagate_transforms(registry_);  // what was just spawned has no place in the world before the first tick
    collision_ = std::make_unique<CollisionScene>(registry_, models_);
    collision_models_ = models_.size();
  }
  PlayerInput rest = input;
  const auto steps = std::max<std::int64_t>(last - tick_, 1);
  rest.turn_right_deg /= static_cast<float>(steps);
  rest.turn_up_deg /= static_cast<float>(steps);
  Result<void> outcome;
  while (tick_ < last) {
    ++tick_;
    SystemContext now = context();
    now.time_s = static_cast<double>(tick_) * simulation_step_s;
    now.input = rest;
    rest.toggle_flying = false;  // pressed once, whatever the number of ticks
    schedule_.run(now, registry_, commands_, Phase::input, Phase::propagate);
    if (!now.script_result && outcome) outcome = now.script_result;
  }
  return outcome;
}

bool World::has_camera() {
  bool found = false;
  registry_.view<const Camera>().each([&](Entity, const Camera& camera) { found |= camera.active; });
  return found;
}

bool World::has_walker() {
  bool found = false;
  registry_.view<const Walker>().each([&](Entity, const Walker&) { found = true; });
  return found;
}

void World::extract(Frame& frame, std::uint64_t number, double time_s, int width, int height) {
  frame = Frame{};
  frame.number = number;
  frame.time_s = time_s;
  frame.width = width;
  frame.height = height;
  frame.scene = scene_;
  frame.affordable_drops = affordable_drops_;
  frame.techniques = techniques_;
  if (time_s != extracted_s_) {
    const bool follows = extracted_s_ >= 0.0 && time_s > extracted_s_;
    step_s_ = follows ? static_cast<float>(time_s - extracted_s_) : Frame{}.step_s;
    extracted_s_ = time_s;
  }
  frame.step_s = step_s_;
  if (!has_camera()) {
    frame.camera.position_m = {0.0, 1.7, 0.0};
    if (!std::exchange(told_of_no_camera_, true))
      log_warn(
          "at {:.3f} s there is no active camera, so the scene is seen from 1.7 m above its origin; make one: "
          "world.spawn{{ camera = {{}}, transform = {{ position_m = {{0, 1.7, 10}} }} }}",
          time_s);
  }
  SystemContext now = context();
  now.time_s = time_s;
  now.interpolation = std::clamp(1.0 - (static_cast<double>(tick_) - time_s / simulation_step_s), 0.0, 1.0);
  now.frame = &frame;
  schedule_.run(now, registry_, commands_, Phase::extract, Phase::extract);
}

fs::path World::render_script() const {
  return cinematic().render.value_or("scripts/render/city.lua");
}

}  // namespace petrichor
