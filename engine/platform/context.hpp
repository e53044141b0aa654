#pragma once
// One interface to OpenGL 4.5 core: a GLFW window, or headless EGL (a hardware device first, then
// surfaceless software). Both draw the same frames: everything is rendered into textures, a window only shows them.

#include <functional>
#include <memory>
#include <string>

#include "engine/core/result.hpp"

namespace petrichor {

struct DeviceInfo {
  std::string renderer;
  std::string vendor;
  std::string version;
  bool software = false;  // llvmpipe, softpipe, SwiftShader
};

// What a person did since the last poll. Positions in pixels, keys by GLFW code.
struct InputState {
  bool key_down[512] = {};
  bool key_pressed[512] = {};  // went down since the last poll
  double mouse_dx = 0, mouse_dy = 0, scroll = 0;
  bool mouse_captured = false;
  bool close_requested = false;
};

class Context {
 public:
  virtual ~Context() = default;
  virtual DeviceInfo device() const = 0;
  virtual bool has_window() const = 0;
  virtual void make_current() = 0;
  // Window only; headless contexts do nothing.
  virtual void framebuffer_size(int& width, int& height) const = 0;
  virtual InputState poll() = 0;
  virtual void capture_mouse(bool) = 0;
  virtual void present() = 0;               // swap buffers
  virtual void* native_window() const = 0;  // GLFWwindow*, for the interface's backend
};

struct ContextOptions {
  bool debug = false;  // debug context: GL errors become messages, and errors in tests
  bool vsync = true;
  int width = 1280, height = 720;
  std::string title = "Petrichor";
};

// Errors say what was found (display, EGL devices, versions) and what is needed.
Result<std::unique_ptr<Context>> make_headless_context(const ContextOptions&);
Result<std::unique_ptr<Context>> make_window_context(const ContextOptions&);
bool display_available();

// Number of GL debug errors since start, and the last one's text. For tests.
int gl_error_count();
std::string last_gl_error();

}  // namespace petrichor
