// The sandbox: the main loop.

#define GLFW_INCLUDE_NONE  // epoxy brings OpenGL
#include <GLFW/glfw3.h>

#include <array>
#include <chrono>
#include <deque>
#include <nlohmann/json.hpp>

#include "components/components.hpp"
#include "engine/core/log.hpp"
#include "engine/core/paths.hpp"
#include "engine/main/commands.hpp"
#include "engine/main/direction.hpp"
#include "engine/main/reload.hpp"
#include "engine/main/renderer.hpp"
#include "engine/main/stats.hpp"
#include "engine/main/world.hpp"
#include "systems/interface/interface.hpp"
#include "systems/rainfall/passes.hpp"

namespace petrichor {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double longest_frame_s = 0.25;  // after a hitch the simulation goes on slower rather than in leaps
constexpr float degrees_per_pixel = 0.12f;

PlayerInput player_input(const InputState& input, bool keyboard_is_free) {
  PlayerInput player;
  if (input.mouse_captured) {
    player.turn_right_deg = static_cast<float>(input.mouse_dx) * degrees_per_pixel;
    player.turn_up_deg = static_cast<float>(-input.mouse_dy) * degrees_per_pixel;
  }
  if (!keyboard_is_free) return player;
  player.forward = input.key_down[GLFW_KEY_W];
  player.back = input.key_down[GLFW_KEY_S];
  player.left = input.key_down[GLFW_KEY_A];
  player.right = input.key_down[GLFW_KEY_D];
  player.up = input.key_down[GLFW_KEY_SPACE];
  player.down = input.key_down[GLFW_KEY_LEFT_CONTROL] || input.key_down[GLFW_KEY_C];
  player.run = input.key_down[GLFW_KEY_LEFT_SHIFT];
  player.toggle_flying = input.key_pressed[GLFW_KEY_F];
  return player;
}

// Keys 1 to 9 reach scripts as the events "key:1" ...
void emit_keys(const InputState& input, ScriptHost& script) {
  for (int key = GLFW_KEY_1; key <= GLFW_KEY_9; ++key)
    if (input.key_pressed[key]) script.emit("key:" + std::to_string(key - GLFW_KEY_0));
}

// What is edited while it runs is taken over; what fails leaves the last good state and is shown.
struct Reloader {
  FileWatch scripts, frame;
  Clock::time_point last = Clock::now();

  void watch(const World& world, const Renderer& renderer) {
    scripts.watch(world.script_files());
    // A table that failed for an artist's shader is tried again when the shader changes.
    std::vector<std::filesystem::path> files = renderer.script_files;
    for (const std::string& name : renderer.graph->files())
      if (const auto file = find_data(name)) files.push_back(*file);
    frame.watch(files);
  }

  void check(const PlayOptions& options, std::unique_ptr<World>& world, Renderer& renderer, double& time_s,
             InterfaceState& interface) {
    if (Clock::now() - last < std::chrono::milliseconds(250)) return;
    last = Clock::now();
    bool shaders_changed = false;
    auto failed = renderer.shaders.reload_changed(&shaders_changed);
    const bool frame_changed = frame.changed(), scripts_changed = scripts.changed();
    if (failed.empty() && !shaders_changed && !frame_changed && !scripts_changed) return;
    interface.errors = std::move(failed);
    if (frame_changed)
      if (auto loaded = load_render_script(renderer, world->render_script()); !loaded)
        interface.errors.push_back(loaded.error().message);
    if (scripts_changed) {
      auto scene = std::make_unique<GpuScene>();
      if (auto again = World::open(options.subject, scene.get())) {
        world = std::move(*again);
        world->set_affordable_drops(affordable_drops(renderer.device));
        renderer.scene = std::move(scene);
        time_s = 0.0;
      } else {
        interface.errors.push_back(again.error().message);
      }
    }
    for (const std::string& error : interface.errors) log_error("{}", error);
    watch(*world, renderer);
  }
};

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void show(const Texture& picture, const Context& context) {
  int width = 0, height = 0;
  context.framebuffer_size(width, height);
  const Framebuffer from = make_framebuffer(std::array{static_cast<GLuint>(picture.id)}, 0);
  glBlitNamedFramebuffer(from, 0, 0, 0, picture.width, picture.height, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                         picture.width == width && picture.height == height ? GL_NEAREST : GL_LINEAR);
}

}  // namespace

Result<void> play(const PlayOptions& options) {
  ContextOptions window;
  window.width = options.width;
  window.height = options.height;
  auto opened = open_renderer(true, window);
  if (!opened) return tl::unexpected(opened.error());
  Renderer& renderer = **opened;
  PlayOptions call = options;
  if (call.subject.subject.empty()) call.subject.subject = "scripts/sandbox.lua";
  auto world_opened = World::open(call.subject, renderer.scene.get());
  if (!world_opened) return tl::unexpected(world_opened.error());
  std::unique_ptr<World> world = std::move(*world_opened);
  world->set_affordable_drops(affordable_drops(renderer.device));
  if (auto loaded = load_render_script(renderer, world->render_script()); !loaded) return loaded;

  auto opened_direction = Direction::open(world->techniques());
  if (!opened_direction) return tl::unexpected(opened_direction.error());
  Direction direction = std::move(*opened_direction);
  bool warm = false;  // every rung that may be chosen has been drawn once

  Interface interface(renderer.context->native_window());
  InterfaceState state;
  state.directed = options.budget_ms > 0.0;
  if (state.directed) state.budget_ms = static_cast<float>(options.budget_ms);
  RunStats stats;
  OverlayInfo overlay;
  overlay.device = renderer.device.renderer;
  Reloader reloader;
  reloader.watch(*world, renderer);
  Frame frame;
  std::deque<float> frame_ms;
  double time_s = 0.0;
  std::int64_t number = 0;
  auto last = Clock::now();
  renderer.context->capture_mouse(true);

  while (true) {
    const InputState input = renderer.context->poll();
    if (input.close_requested || input.key_pressed[GLFW_KEY_ESCAPE]) break;
    if (options.stop_after_frames && number >= options.stop_after_frames) break;
    if (input.key_pressed[GLFW_KEY_F1]) state.show_times = !state.show_times;
    if (input.key_pressed[GLFW_KEY_F2]) state.show_inspector = !state.show_inspector;
    // The inspector needs the pointer, walking needs it away.
    if (input.key_pressed[GLFW_KEY_TAB])
      renderer.context->capture_mouse(!input.mouse_captured);
    else if (input.key_pressed[GLFW_KEY_F2])
      renderer.context->capture_mouse(!state.show_inspector);

    const auto now = Clock::now();
    const double spent_s = std::chrono::duration<double>(now - last).count();
    last = now;
    time_s += std::min(spent_s, longest_frame_s);
    const auto work_start = Clock::now();
    emit_keys(input, world->script());
    if (auto advanced = world->advance_to(time_s, player_input(input, !interface.wants_keyboard())); !advanced) {
      state.errors = {advanced.error().message};
      log_error("{}", advanced.error().message);
    }
    reloader.check(call, world, renderer, time_s, state);

    int width = 0, height = 0;
    bool just_warmed = false;
    renderer.context->framebuffer_size(width, height);
    if (width > 0 && height > 0) {
      direction.budget_ms = state.directed ? state.budget_ms : 0.0;
      if (state.directed && !std::exchange(warm, true)) {
        if (auto warmed = direction.warm_up(renderer, *world, time_s, width, height); !warmed)
          state.errors = {warmed.error().message};
        just_warmed = true;
        last = Clock::now();  // that is no frame
      }
      direction.extract(*world, frame, static_cast<std::uint64_t>(number), time_s, std::min(spent_s, longest_frame_s),
                        width, height);
      // On software OpenGL, looking at the times costs a few glFinishes; only then are they paid.
      const bool profile = state.directed ? direction.profile() : state.show_times && number % 8 == 0;
      const auto picture = draw(renderer, frame, profile);
      if (picture)
        show(**picture, *renderer.context);
      else if (state.errors.empty())
        state.errors = {picture.error().message};
    }
    auto timings = renderer.timer->collect();
    // The frame's own work. On a GPU that runs beside us: the longer of what each of us took.
    double work_ms = 0.0;
    if (renderer.device.software) {
      if (state.directed) glFinish();
      work_ms = milliseconds_since(work_start);
    } else {
      for (const Timing& pass : timings) work_ms += pass.milliseconds;
      work_ms = timings.empty() ? 0.0 : std::max(work_ms, milliseconds_since(work_start));
    }
    if (state.directed && work_ms > 0.0)
      direction.measured(just_warmed ? 0.0 : work_ms, timings, renderer.timer->gpu_times_are_real());
    if (!options.stats.empty() && number > 0) {
      stats.frame_ms.push_back(state.directed ? work_ms : spent_s * 1000.0);
      stats.add(timings);
    }
    frame_ms.push_back(static_cast<float>(spent_s * 1000.0));
    if (frame_ms.size() > 240) frame_ms.pop_front();
    if (!timings.empty()) overlay.pass_ms = std::move(timings);
    if (state.show_times) overlay.director = direction.notes();
    overlay.frame_ms.assign(frame_ms.begin(), frame_ms.end());
    overlay.rain_mm_per_hour = frame.rain ? frame.rain->rain_mm_per_hour : 0.0f;
    if (state.show_times) overlay.drops_drawn = rain_stats(frame).drops_drawn;
    interface.draw(state, overlay, world->registry(), component_schemas());
    renderer.context->present();
    ++number;
  }
  if (!options.stats.empty()) {
    auto json = to_json(stats, renderer.device, options.width, options.height, number, rain_stats(frame).drops_drawn,
                        renderer.timer->gpu_times_are_real());
    json["budget_ms"] = state.directed ? state.budget_ms : 0.0f;
    json["director"] = direction.report();
    json["director_changes"] = direction.changes();
    json["frames_ms"] = stats.frame_ms;  // each of them, to see what a change cost
    return write_whole_file(options.stats, json.dump(2) + "\n");
  }
  return {};
}

}  // namespace petrichor
