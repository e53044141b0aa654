#pragma once
// GLSL programs from files. `#include "systems/..."` is resolved against the data roots; compile errors
// name the real file and line. Programs reload while running: one that fails keeps its last good version.
// A reload starts with fresh uniforms: set them every frame, and give samplers and images layout(binding = n).

#include <epoxy/gl.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
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
  // Sets a scalar or vector uniform of whatever basic type the shader gave it, from the front of `values`.
  // False: no such uniform, another number of components, or a type this cannot set (matrix, sampler).
  bool set_numbers(std::string_view uniform, std::span<const double> values) const;
  bool has_uniform(std::string_view uniform) const { return location(uniform) >= 0; }
  // The GL type (GL_SAMPLER_2D, GL_IMAGE_2D, GL_FLOAT_VEC3 ...) of an active uniform, 0 where there is none.
  GLenum uniform_type(std::string_view uniform) const;
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
  ShaderLibrary();
  ~ShaderLibrary();
  ShaderLibrary(const ShaderLibrary&) = delete;
  ShaderLibrary& operator=(const ShaderLibrary&) = delete;
  // Loads once; the pointer stays valid, also across reloads, as long as the library lives.
  Result<const Program*> load(const ShaderKey&);
  // Rebuilds what depends on files that changed on disk since. Returns one message per failure; those
  // programs keep running as they were. `changed` tells whether anything was rebuilt.
  std::vector<std::string> reload_changed(bool* changed = nullptr);
  // Counts successful rebuilds; a user who caches something of a program compares it.
  std::uint64_t generation() const { return generation_; }

 private:
  struct Entry;
  static void install(Entry&, GLuint id);
  std::vector<std::unique_ptr<Entry>> entries_;
  std::uint64_t generation_ = 0;
};

}  // namespace petrichor
