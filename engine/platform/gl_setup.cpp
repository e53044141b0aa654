#include "engine/platform/gl_setup.hpp"

#include <dlfcn.h>
#include <epoxy/gl.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <mutex>
#include <set>
#include <vector>

namespace petrichor {
namespace {

std::atomic<int> error_count{0};
std::mutex message_mutex;  // drivers may call back from their own threads
std::string last_error;
std::set<std::string> logged;
std::vector<std::string> groups;  // open debug groups: the passes of the frame name themselves so

void on_debug_message(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                      const void*) {
  // Shader compile and link failures come back as Result values from the shader loader.
  if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
  // Where a driver keeps a buffer is its own affair.
  if (type == GL_DEBUG_TYPE_PERFORMANCE && severity != GL_DEBUG_SEVERITY_HIGH) return;
  if (type == GL_DEBUG_TYPE_PUSH_GROUP || type == GL_DEBUG_TYPE_POP_GROUP) {
    std::lock_guard lock(message_mutex);
    if (type == GL_DEBUG_TYPE_PUSH_GROUP) {
      groups.emplace_back(text);
    } else if (!groups.empty()) {
      groups.pop_back();
    }
    return;
  }
  std::string message(text, length >= 0 ? static_cast<std::size_t>(length) : std::char_traits<char>::length(text));
  while (!message.empty() && (message.back() == '\n' || message.back() == ' ')) message.pop_back();
  std::lock_guard lock(message_mutex);
  if (!groups.empty()) message += " (in " + groups.back() + ")";
  if (type == GL_DEBUG_TYPE_ERROR) {
    ++error_count;
    last_error = message;
  }
  const bool important =
      type == GL_DEBUG_TYPE_ERROR || severity == GL_DEBUG_SEVERITY_HIGH || severity == GL_DEBUG_SEVERITY_MEDIUM;
  // A fault inside a frame repeats sixty times a second: say it once, and bound what is remembered.
  if (!important || logged.size() > 500 || !logged.insert(message).second) return;
  if (type == GL_DEBUG_TYPE_ERROR) {
    spdlog::error("OpenGL: {}", message);
  } else {
    spdlog::warn("OpenGL: {}", message);
  }
}

bool can_open(const char* library) {
  // The handle is kept on purpose: libepoxy opens the same library again.
  return dlopen(library, RTLD_LAZY | RTLD_LOCAL) != nullptr;
}

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text ? text : "";
}

}  // namespace

int gl_error_count() {
  return error_count;
}

std::string last_gl_error() {
  std::lock_guard lock(message_mutex);
  return last_error;
}

bool gl_libraries_present(bool need_egl, std::string& message) {
  if (need_egl && !can_open("libEGL.so.1")) {
    message = "libEGL.so.1 was not found; install libegl1 and libgl1-mesa-dri";
    return false;
  }
  if (!can_open("libOpenGL.so.0") && !can_open("libGL.so.1")) {
    message = "neither libOpenGL.so.0 nor libGL.so.1 was found; install libgl1 and libgl1-mesa-dri";
    return false;
  }
  return true;
}

void set_up_current_context(bool debug) {
  if (debug) {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(on_debug_message, nullptr);
    // Notifications are chatter (buffer placement and the like).
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, nullptr, GL_FALSE);
    for (const GLenum type : {GL_DEBUG_TYPE_PUSH_GROUP, GL_DEBUG_TYPE_POP_GROUP}) {
      glDebugMessageControl(GL_DONT_CARE, type, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    }
  }
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

DeviceInfo describe_current_device() {
  DeviceInfo info{gl_string(GL_RENDERER), gl_string(GL_VENDOR), gl_string(GL_VERSION)};
  for (const char* name : {"llvmpipe", "softpipe", "SwiftShader", "Software Rasterizer", "swrast"}) {
    if (info.renderer.find(name) != std::string::npos) info.software = true;
  }
  return info;
}

int current_gl_version() {
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  return major * 10 + minor;
}

}  // namespace petrichor
