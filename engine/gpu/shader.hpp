#pragma once
// GLSL programs from files. `#include "systems/..."` is resolved against the data roots; compile errors
// name the real file and line. Programs reload while running: one that fails keeps its last good version.

#include <epoxy/gl.h>

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/objects.hpp"

namespace petrichor {

class Program {
 public:
  GLuint id() const { return id_; }
  void use() const { glUseProgram(id_); }
  // Unknown or optimised-out uniforms are ignored.
  void set(std::string_view uniform, float) const;
  void set(std::string_view uniform, int) const;
  void set(std::string_view uniform, unsigned) const;
  void set(std::string_view uniform, const glm::vec2&) const;
  void set(std::string_view uniform, const glm::vec3&) const;
  void set(std::string_view uniform, const glm::vec4&) const;
  void set(std::string_view uniform, const glm::ivec2&) const;
  void set(std::string_view uniform, const glm::uvec2&) const;
  void set(std::string_view uniform, const glm::mat4&) const;
  glm::ivec3 group_size() const { return group_size_; }  // compute only
  // glDispatchCompute over at least this many invocations.
  void dispatch(int x, int y = 1, int z = 1) const;

 private:
  friend class ShaderLibrary;
  GLint location(std::string_view uniform) const;
  GlId<delete_program> id_;
  glm::ivec3 group_size_{1};
  mutable std::map<std::string, GLint, std::less<>> locations_;
};

// What to build: {"systems/x/y.comp.glsl"} or {"a.vert.glsl", "a.frag.glsl"}; defines are "NAME" or "NAME value".
struct ShaderKey {
  std::vector<std::string> files;
  std::vector<std::string> defines;
  friend bool operator==(const ShaderKey&, const ShaderKey&) = default;
};

class ShaderLibrary {
 public:
  // Loads once; the pointer stays valid, also across reloads, as long as the library lives.
  Result<const Program*> load(const ShaderKey&);
  // Rebuilds what depends on files that changed on disk since. Returns one message per failure; those
  // programs keep running as they were. `changed` tells whether anything was rebuilt.
  std::vector<std::string> reload_changed(bool* changed = nullptr);

 private:
  struct Entry;
  std::vector<std::shared_ptr<Entry>> entries_;
};

}  // namespace petrichor
