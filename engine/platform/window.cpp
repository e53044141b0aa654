// A GLFW window with an OpenGL 4.5 core context, and the person's input.

#include <epoxy/gl.h>
// epoxy first: GLFW then leaves the OpenGL headers alone
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <cstdlib>
#include <string>

#include "engine/platform/context.hpp"
#include "engine/platform/gl_setup.hpp"

namespace petrichor {
namespace {

std::string glfw_message() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

// glfwInit once, glfwTerminate after the last user: display_available() and windows may overlap.
bool acquire_glfw(int& users) {
  return users++ > 0 || glfwInit() == GLFW_TRUE;
}
void release_glfw(int& users) {
  if (--users == 0) glfwTerminate();
}
int glfw_users = 0;

bool display_variable_set() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* value = std::getenv(name);
    if (value && *value) return true;
  }
  return false;
}

class WindowContext final : public Context {
 public:
  explicit WindowContext(GLFWwindow* window) : window_(window) {
    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
      if (key < 0 || key >= 512) return;
      InputState& input = of(w).input_;
      if (action == GLFW_PRESS) input.key_down[key] = input.key_pressed[key] = true;
      if (action == GLFW_RELEASE) input.key_down[key] = false;
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double dy) { of(w).input_.scroll += dy; });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) { of(w).move_mouse(x, y); });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
      // Keys held while the focus leaves never send their release.
      if (!focused) std::fill(std::begin(of(w).input_.key_down), std::end(of(w).input_.key_down), false);
      of(w).mouse_known_ = false;
    });
  }
  ~WindowContext() override {
    glfwDestroyWindow(window_);
    release_glfw(glfw_users);
  }
  DeviceInfo device() const override { return info_; }
  bool has_window() const override { return true; }
  void make_current() override { glfwMakeContextCurrent(window_); }
  void framebuffer_size(int& width, int& height) const override { glfwGetFramebufferSize(window_, &width, &height); }
  InputState poll() override {
    glfwPollEvents();
    input_.close_requested = glfwWindowShouldClose(window_) == GLFW_TRUE;
    const InputState now = input_;
    std::fill(std::begin(input_.key_pressed), std::end(input_.key_pressed), false);
    input_.mouse_dx = input_.mouse_dy = input_.scroll = 0;
    return now;
  }
  void capture_mouse(bool capture) override {
    if (capture == input_.mouse_captured) return;
    glfwSetInputMode(window_, GLFW_CURSOR, capture ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    if (glfwRawMouseMotionSupported()) glfwSetInputMode(window_, GLFW_RAW_MOUSE_MOTION, capture);
    input_.mouse_captured = capture;
    mouse_known_ = false;  // the cursor jumps; the jump is no movement
  }
  void present() override { glfwSwapBuffers(window_); }
  void* native_window() const override { return window_; }
  void remember_device() { info_ = describe_current_device(); }

 private:
  static WindowContext& of(GLFWwindow* window) {
    return *static_cast<WindowContext*>(glfwGetWindowUserPointer(window));
  }
  void move_mouse(double x, double y) {
    if (mouse_known_) {
      input_.mouse_dx += x - mouse_x_;
      input_.mouse_dy += y - mouse_y_;
    }
    mouse_x_ = x;
    mouse_y_ = y;
    mouse_known_ = true;
  }

  GLFWwindow* window_;
  InputState input_;
  DeviceInfo info_;
  bool mouse_known_ = false;
  double mouse_x_ = 0, mouse_y_ = 0;
};

}  // namespace

bool display_available() {
  if (!display_variable_set()) return false;
  const bool available = acquire_glfw(glfw_users);
  release_glfw(glfw_users);
  return available;
}

Result<std::unique_ptr<Context>> make_window_context(const ContextOptions& options) {
  std::string missing;
  if (!gl_libraries_present(false, missing)) return failure("No window: " + missing + ".");
  if (!display_variable_set()) {
    return failure(
        "No window: neither DISPLAY nor WAYLAND_DISPLAY is set. Run in a desktop session, or render headless.");
  }
  if (!acquire_glfw(glfw_users)) {
    std::string why = glfw_message();
    release_glfw(glfw_users);
    return failure("No window: " + why + ". Check DISPLAY, or render headless.");
  }
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, options.debug);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);  // the window only shows a texture
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  GLFWwindow* window = glfwCreateWindow(options.width, options.height, options.title.c_str(), nullptr, nullptr);
  if (!window) {
    std::string why = glfw_message();
    // Say what the display does offer.
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    std::string offered = "no OpenGL";
    if (GLFWwindow* probe = glfwCreateWindow(16, 16, "", nullptr, nullptr)) {
      glfwMakeContextCurrent(probe);
      const DeviceInfo info = describe_current_device();
      offered = fmt::format("OpenGL {} on {}", info.version, info.renderer);
      glfwDestroyWindow(probe);
    }
    release_glfw(glfw_users);
    return failure(fmt::format(
        "No window with OpenGL 4.5 core: {}. The display offers {}. Needed: a graphics driver with OpenGL 4.5, or in "
        "software the package libgl1-mesa-dri.",
        why, offered));
  }
  auto context = std::make_unique<WindowContext>(window);
  context->make_current();
  glfwSwapInterval(options.vsync ? 1 : 0);
  context->remember_device();
  set_up_current_context(options.debug);
  return std::unique_ptr<Context>(std::move(context));
}

}  // namespace petrichor
