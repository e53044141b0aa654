#pragma once
// What stands over the picture in the window: the times, the inspector, and errors of scripts and shaders.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/ecs/registry.hpp"
#include "engine/ecs/schema.hpp"
#include "engine/gpu/timer.hpp"
#include "systems/director_note.hpp"
#include "systems/interface/inspector.hpp"

namespace petrichor {

struct OverlayInfo {
  std::string device;
  std::vector<float> frame_ms;  // the last ones, oldest first
  std::vector<Timing> pass_ms;  // of the newest frame that is known
  std::uint64_t drops_drawn = 0;
  float rain_mm_per_hour = 0.0f;
  std::vector<DirectorNote> director;  // what it chose and why; empty: it is not there
};

struct InterfaceState {
  bool show_times = false;      // F1
  bool show_inspector = false;  // F2
  bool directed = false;        // the director keeps frames within budget_ms
  float budget_ms = 16.0f;
  InspectorState inspector;
  std::vector<std::string> errors;  // of the last reload; empty: none
};

// Dear ImGui over a GLFW window and the current GL context.
class Interface {
 public:
  explicit Interface(void* glfw_window);
  ~Interface();
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;

  bool wants_mouse() const;
  bool wants_keyboard() const;
  // Draws onto the window's framebuffer.
  void draw(InterfaceState&, const OverlayInfo&, Registry&, std::span<const Schema>);
};

// The windows alone, between NewFrame and Render.
void draw_windows(InterfaceState&, const OverlayInfo&, Registry&, std::span<const Schema>);

}  // namespace petrichor
