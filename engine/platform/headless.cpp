// Headless OpenGL through EGL. Every EGL device is asked in turn, hardware before software, and Mesa's
// surfaceless platform after them; the first that gives an OpenGL 4.5 core context wins.
// PETRICHOR_DEVICE=hardware|software|INDEX narrows the choice.

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "engine/platform/context.hpp"
#include "engine/platform/gl_setup.hpp"

namespace petrichor {
namespace {

const char* egl_error_name(EGLint error) {
  switch (error) {
    case EGL_SUCCESS:
      return "no error";
    case EGL_NOT_INITIALIZED:
      return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS:
      return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC:
      return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
      return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
      return "EGL_BAD_CONFIG";
    case EGL_BAD_CONTEXT:
      return "EGL_BAD_CONTEXT";
    case EGL_BAD_DISPLAY:
      return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH:
      return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER:
      return "EGL_BAD_PARAMETER";
    default:
      return "an unknown EGL error";
  }
}

bool has_word(const char* list, std::string_view word) {
  if (!list) return false;
  std::string_view text(list);
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || text[at - 1] == ' ') && (end == text.size() || text[end] == ' ')) return true;
  }
  return false;
}

struct Candidate {
  EGLDeviceEXT device = nullptr;  // null: Mesa's surfaceless platform
  bool software = false;
  std::string name;
};

std::vector<Candidate> list_candidates() {
  std::vector<Candidate> hardware, software;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const bool enumerates = has_word(client, "EGL_EXT_device_enumeration") || has_word(client, "EGL_EXT_device_base");
  if (enumerates && has_word(client, "EGL_EXT_platform_device")) {
    EGLDeviceEXT devices[64];
    EGLint count = 0;
    if (!eglQueryDevicesEXT(64, devices, &count)) count = 0;
    for (EGLint i = 0; i < count; ++i) {
      Candidate candidate{devices[i]};
      const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
      candidate.software = has_word(extensions, "EGL_MESA_device_software");
      candidate.name = fmt::format("EGL device {}", i);
      if (candidate.software) candidate.name += " (software)";
      if (has_word(extensions, "EGL_NV_device_cuda")) candidate.name += " (NVIDIA)";
      if (has_word(extensions, "EGL_EXT_device_drm")) {
        const char* file = eglQueryDeviceStringEXT(devices[i], EGL_DRM_DEVICE_FILE_EXT);
        if (file) candidate.name += fmt::format(" ({})", file);
      }
      (candidate.software ? software : hardware).push_back(std::move(candidate));
    }
  }
  // Mesa's surfaceless platform picks a hardware driver where it may open one, else llvmpipe.
  if (has_word(client, "EGL_MESA_platform_surfaceless")) hardware.push_back({nullptr, false, "Mesa surfaceless"});
  hardware.insert(hardware.end(), software.begin(), software.end());
  return hardware;
}

class HeadlessContext final : public Context {
 public:
  HeadlessContext(EGLDisplay display, EGLSurface surface, EGLContext context)
      : display_(display), surface_(surface), context_(context) {}
  ~HeadlessContext() override {
    if (eglGetCurrentContext() == context_) {
      eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    if (surface_ != EGL_NO_SURFACE) eglDestroySurface(display_, surface_);
    eglDestroyContext(display_, context_);
    // The display stays: another context may share it, and eglTerminate unloads drivers that do not clean up.
  }
  DeviceInfo device() const override { return info_; }
  bool has_window() const override { return false; }
  void make_current() override { eglMakeCurrent(display_, surface_, surface_, context_); }
  void framebuffer_size(int& width, int& height) const override { width = height = 0; }
  InputState poll() override { return {}; }
  void capture_mouse(bool) override {}
  void present() override {}
  void* native_window() const override { return nullptr; }
  void remember_device() { info_ = describe_current_device(); }

 private:
  EGLDisplay display_;
  EGLSurface surface_;
  EGLContext context_;
  DeviceInfo info_;
};

EGLContext create_gl_context(EGLDisplay display, EGLConfig config, int major, int minor, bool debug) {
  std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION, major, EGL_CONTEXT_MINOR_VERSION, minor};
  if (major > 3 || (major == 3 && minor >= 2)) {
    attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT});
  }
  if (debug) attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
  attributes.push_back(EGL_NONE);
  return eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
}

// What this device can do at most, for the message when 4.5 is refused.
std::string best_version(EGLDisplay display, EGLConfig config) {
  constexpr int versions[][2] = {{4, 4}, {4, 3}, {4, 2}, {4, 1}, {4, 0}, {3, 3}, {3, 2}, {3, 1}, {3, 0}, {2, 1}};
  for (const auto& [major, minor] : versions) {
    EGLContext context = create_gl_context(display, config, major, minor, false);
    if (context == EGL_NO_CONTEXT) continue;
    eglDestroyContext(display, context);
    return fmt::format("OpenGL {}.{} at most", major, minor);
  }
  return "no desktop OpenGL";
}

Result<std::unique_ptr<HeadlessContext>> try_candidate(const Candidate& candidate, bool debug) {
  EGLDisplay display = candidate.device
                           ? eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, candidate.device, nullptr)
                           : eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY) return failure("no EGL display");
  EGLint major = 0, minor = 0;
  if (!eglInitialize(display, &major, &minor)) {
    return failure(fmt::format("cannot be opened ({})", egl_error_name(eglGetError())));
  }
  const char* vendor = eglQueryString(display, EGL_VENDOR);
  const std::string who = fmt::format("EGL {}.{}, {}", major, minor, vendor ? vendor : "unknown vendor");
  if (!eglBindAPI(EGL_OPENGL_API)) return failure(who + ": has no desktop OpenGL");

  const EGLint config_attributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  if (!eglChooseConfig(display, config_attributes, &config, 1, &configs) || configs == 0) {
    if (!epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) {
      return failure(who + ": has no configuration for OpenGL");
    }
    config = EGL_NO_CONFIG_KHR;
  }
  EGLContext context = create_gl_context(display, config, 4, 5, debug);
  if (context == EGL_NO_CONTEXT) return failure(fmt::format("{}: {}", who, best_version(display, config)));

  EGLSurface surface = EGL_NO_SURFACE;
  bool current = epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context") &&
                 eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
  if (!current && config != EGL_NO_CONFIG_KHR) {
    const EGLint pbuffer_attributes[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    surface = eglCreatePbufferSurface(display, config, pbuffer_attributes);
    current = surface != EGL_NO_SURFACE && eglMakeCurrent(display, surface, surface, context);
  }
  if (!current) {
    const EGLint error = eglGetError();
    if (surface != EGL_NO_SURFACE) eglDestroySurface(display, surface);
    eglDestroyContext(display, context);
    return failure(fmt::format("{}: the context cannot be made current ({})", who, egl_error_name(error)));
  }
  auto result = std::make_unique<HeadlessContext>(display, surface, context);
  result->remember_device();
  if (current_gl_version() < 45) return failure(fmt::format("{}: gives {}", who, result->device().version));
  return result;
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

Result<std::unique_ptr<Context>> make_headless_context(const ContextOptions& options) {
  std::string missing;
  if (!gl_libraries_present(true, missing)) return failure("No OpenGL: " + missing + ".");
  // Mesa prints a warning for each device node it may not open; the message below says it better.
  setenv("EGL_LOG_LEVEL", "fatal", 0);

  const std::string wish = environment("PETRICHOR_DEVICE");
  std::vector<Candidate> candidates = list_candidates();
  int only = -1;
  if (!wish.empty() && wish != "software" && wish != "hardware") {
    const auto [end, error] = std::from_chars(wish.data(), wish.data() + wish.size(), only);
    if (error != std::errc{} || *end || only < 0 || only >= static_cast<int>(candidates.size())) {
      return failure(fmt::format("PETRICHOR_DEVICE={}: expected software, hardware or a number below {}.", wish,
                                 candidates.size()));
    }
  }
  if (wish == "software") setenv("LIBGL_ALWAYS_SOFTWARE", "1", 0);  // Mesa surfaceless obeys it too

  std::string found;
  std::unique_ptr<HeadlessContext> fallback;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (only >= 0 && static_cast<int>(i) != only) continue;
    const Candidate& candidate = candidates[i];
    if (wish == "hardware" && candidate.software) continue;
    if (candidate.software && fallback) break;  // nothing better will come
    auto made = try_candidate(candidate, options.debug);
    if (!made) {
      found += fmt::format("\n  {} {}: {}", i, candidate.name, made.error().message);
      continue;
    }
    const DeviceInfo info = (*made)->device();
    found += fmt::format("\n  {} {}: {}, OpenGL {}", i, candidate.name, info.renderer, info.version);
    const bool good = only >= 0 || (wish == "software" ? info.software : !info.software);
    if (good) {
      fallback.reset();
      (*made)->make_current();
      set_up_current_context(options.debug);
      return std::unique_ptr<Context>(std::move(*made));
    }
    // Software where hardware was looked for: keep it, and see whether something better follows.
    if (wish.empty() && !fallback) fallback = std::move(*made);
  }
  if (fallback) {
    fallback->make_current();
    set_up_current_context(options.debug);
    return std::unique_ptr<Context>(std::move(fallback));
  }
  if (found.empty()) found = "\n  no EGL device at all";
  return failure(fmt::format(
      "No usable OpenGL without a window{}. Found:{}\nNeeded: OpenGL 4.5 core through EGL, from a graphics driver or, "
      "in software, from the packages libegl-mesa0 and libgl1-mesa-dri.",
      wish.empty() ? "" : " for PETRICHOR_DEVICE=" + wish, found));
}

}  // namespace petrichor
