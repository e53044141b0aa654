// Clearing buffers and textures, by the command or by a compute shader, whichever is fast here.

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <string>
#include <string_view>

#include "engine/gpu/formats.hpp"
#include "engine/gpu/objects.hpp"

namespace petrichor {
namespace {

constexpr std::size_t kWorthADispatchBytes = 256 << 10;
constexpr GLuint kUnit = 7;  // the last that OpenGL 4.5 promises, of images as of storage buffers

bool software_gl() {
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string_view name = renderer ? renderer : "";
  return name.find("llvmpipe") != name.npos || name.find("softpipe") != name.npos ||
         name.find("SwiftShader") != name.npos;
}

GLuint compile(const std::string& name, const std::string& source) {
  const char* text = source.c_str();
  const GLuint program = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &text);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  assert(linked && "a shader of the engine's own");
  glObjectLabel(GL_PROGRAM, program, -1, name.c_str());
  return program;
}

// The program of that name in the current context. Ids are reused from context to context, labels are not.
GLuint program_named(const std::string& name, const std::string& source) {
  static thread_local std::map<std::string, GLuint> programs;
  GLuint& id = programs[name];
  if (id && glIsProgram(id)) {
    char label[64] = {};
    glGetObjectLabel(GL_PROGRAM, id, sizeof label, nullptr, label);
    if (name == label) return id;
  }
  return id = compile(name, source);
}

// Puts the caller's program back.
struct ProgramInUse {
  explicit ProgramInUse(GLuint program) {
    glGetIntegerv(GL_CURRENT_PROGRAM, &before_);
    glUseProgram(program);
  }
  ~ProgramInUse() {
    // A program deleted while it was in use is gone by now.
    glUseProgram(glIsProgram(static_cast<GLuint>(before_)) ? static_cast<GLuint>(before_) : 0);
  }
  GLint before_ = 0;
};

void clear_buffer_by_compute(const Buffer& buffer) {
  const GLuint program = program_named("petrichor clear buffer", R"(#version 450 core
layout(local_size_x = 256) in;
layout(std430, binding = 7) writeonly buffer Words { uint words[]; };
void main() {
  const uint step = gl_NumWorkGroups.x * 256u;
  for (uint i = gl_GlobalInvocationID.x; i < uint(words.length()); i += step) words[i] = 0u;
}
)");
  const ProgramInUse in_use(program);
  GLint bound = 0;
  GLint64 start = 0, size = 0;
  glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, kUnit, &bound);
  glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, kUnit, &start);
  glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, kUnit, &size);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kUnit, buffer.id);
  const std::size_t groups = (buffer.bytes / 4 + 255) / 256;
  glDispatchCompute(static_cast<GLuint>(std::min<std::size_t>(groups, 65535)), 1, 1);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  if (bound && size > 0) {
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, kUnit, static_cast<GLuint>(bound), start, size);
  } else {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kUnit, static_cast<GLuint>(bound));
  }
}

void clear_texture_by_compute(const Texture& texture, const FormatInfo& info, const std::array<float, 4>& value) {
  const bool layered = texture.target != GL_TEXTURE_2D;
  // "r32ui" against "r32i": the letters before the sign of integer formats
  const std::string kind = !info.integer ? "" : info.name.ends_with("ui") ? "u" : "i";
  const std::string name = fmt::format("petrichor clear {}image {}", kind, layered);
  const GLuint program = program_named(name, fmt::format(R"(#version 450 core
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 7) uniform writeonly {0}image{1} target;
layout(location = 0) uniform vec4 value;
void main() {{
  const ivec3 at = ivec3(gl_GlobalInvocationID);
  if (all(lessThan(at.xy, imageSize(target).xy))) imageStore(target, at.{2}, {0}vec4(value));
}}
)",
                                                         kind, layered ? "2DArray" : "2D", layered ? "xyz" : "xy"));
  const ProgramInUse in_use(program);
  glProgramUniform4fv(program, 0, 1, value.data());
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  for (int level = 0; level < texture.levels; ++level) {
    glBindImageTexture(kUnit, texture.id, level, layered, 0, GL_WRITE_ONLY, texture.format);
    const auto groups = [&](int size) { return static_cast<GLuint>((std::max(1, size >> level) + 7) / 8); };
    glDispatchCompute(groups(texture.width), groups(texture.height), static_cast<GLuint>(texture.layers));
  }
  glBindImageTexture(kUnit, 0, 0, GL_FALSE, 0, GL_READ_ONLY, GL_R32F);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void clear_texture_by_command(const Texture& texture, const FormatInfo* info, const std::array<float, 4>& value) {
  for (int level = 0; level < texture.levels; ++level) {
    if (info && info->depth) {
      glClearTexImage(texture.id, level, GL_DEPTH_COMPONENT, GL_FLOAT, value.data());
    } else if (info && info->integer) {
      const std::array<GLint, 4> whole{static_cast<GLint>(value[0]), static_cast<GLint>(value[1]),
                                       static_cast<GLint>(value[2]), static_cast<GLint>(value[3])};
      glClearTexImage(texture.id, level, GL_RGBA_INTEGER, GL_INT, whole.data());
    } else {
      glClearTexImage(texture.id, level, GL_RGBA, GL_FLOAT, value.data());
    }
  }
}

}  // namespace

void clear_buffer(const Buffer& buffer, ClearBy by) {
  if (buffer.bytes == 0) return;
  const bool words = buffer.bytes % 4 == 0;
  if (by == ClearBy::fastest) {
    by = buffer.bytes >= kWorthADispatchBytes && !software_gl() ? ClearBy::compute : ClearBy::command;
  }
  if (by == ClearBy::compute && words) {
    clear_buffer_by_compute(buffer);
    return;
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  const GLuint zero = 0;
  if (words) {
    glClearNamedBufferData(buffer.id, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
  } else {
    glClearNamedBufferData(buffer.id, GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, &zero);
  }
}

void clear_texture(const Texture& texture, const std::array<float, 4>& value, ClearBy by) {
  const FormatInfo* info = find_format(texture.format);
  const bool possible = info && info->image;
  if (by == ClearBy::fastest) {
    const std::size_t bytes = info ? std::size_t{1} * info->bytes_per_pixel * texture.width * texture.height : 0;
    by = bytes * texture.layers >= kWorthADispatchBytes && !software_gl() ? ClearBy::compute : ClearBy::command;
  }
  if (by == ClearBy::compute && possible) {
    clear_texture_by_compute(texture, *info, value);
  } else {
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    clear_texture_by_command(texture, info, value);
  }
}

}  // namespace petrichor
