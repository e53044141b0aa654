#include "engine/gpu/shader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cassert>
#include <filesystem>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <system_error>

#include "engine/core/paths.hpp"
#include "engine/core/log.hpp"
#include "engine/gpu/shader_source.hpp"

namespace petrichor {
namespace {

struct Stage {
  std::string_view extension;
  GLenum type;
};
constexpr Stage kStages[] = {
    {".comp.glsl", GL_COMPUTE_SHADER},      {".vert.glsl", GL_VERTEX_SHADER},
    {".frag.glsl", GL_FRAGMENT_SHADER},     {".geom.glsl", GL_GEOMETRY_SHADER},
    {".tesc.glsl", GL_TESS_CONTROL_SHADER}, {".tese.glsl", GL_TESS_EVALUATION_SHADER},
};

// Changes with every save; size too, for file systems with coarse times.
struct Stamp {
  std::filesystem::file_time_type time;
  std::uintmax_t size = 0;
  friend bool operator==(const Stamp&, const Stamp&) = default;
};

std::optional<Stamp> stamp_of(const std::filesystem::path& path) {
  std::error_code error;
  Stamp stamp{std::filesystem::last_write_time(path, error)};
  if (error) return std::nullopt;
  stamp.size = std::filesystem::file_size(path, error);
  if (error) return std::nullopt;
  return stamp;
}

struct Dependency {
  SourceFile file;
  std::optional<Stamp> stamp;  // none: was not there
};

void remember(std::vector<Dependency>& dependencies, const std::vector<SourceFile>& files) {
  for (const SourceFile& file : files) {
    const bool known = std::any_of(dependencies.begin(), dependencies.end(), [&](const Dependency& d) {
      return d.file.path == file.path && d.file.name == file.name;
    });
    if (!known) dependencies.push_back({file, file.path.empty() ? std::nullopt : stamp_of(file.path)});
  }
}

bool has_changed(const Dependency& dependency) {
  if (dependency.file.path.empty()) return find_data(dependency.file.name).has_value();
  const std::optional<Stamp> now = stamp_of(dependency.file.path);
  // Editors replace a file by rename: while it is away, wait.
  return now && now != dependency.stamp;
}

std::string info_log(GLuint object, bool is_program) {
  GLint length = 0;
  is_program ? glGetProgramiv(object, GL_INFO_LOG_LENGTH, &length) : glGetShaderiv(object, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  GLsizei written = 0;
  is_program ? glGetProgramInfoLog(object, length, &written, log.data())
             : glGetShaderInfoLog(object, length, &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  return log;
}

void delete_shader(GLuint id) {
  glDeleteShader(id);
}

Result<GLuint> build(const ShaderKey& key, std::vector<Dependency>& dependencies) {
  const auto start = std::chrono::steady_clock::now();
  GlId<delete_program> program(glCreateProgram());
  std::vector<GlId<delete_shader>> shaders;
  std::vector<SourceFile> all_files;
  for (const std::string& name : key.files) {
    const auto stage = std::find_if(std::begin(kStages), std::end(kStages),
                                    [&](const Stage& s) { return std::string_view(name).ends_with(s.extension); });
    if (stage == std::end(kStages)) {
      return failure(
          fmt::format("{}: a shader's name ends in .comp.glsl, .vert.glsl, .frag.glsl, .geom.glsl, .tesc.glsl "
                      "or .tese.glsl",
                      name));
    }
    std::vector<SourceFile> files;
    auto source = read_shader(name, key.defines, &files);
    remember(dependencies, files);
    if (!source) return tl::unexpected(source.error());
    if (all_files.empty()) all_files = files;

    const GLuint shader = glCreateShader(stage->type);
    shaders.emplace_back(shader);
    const char* text = source->text.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) {
      const std::string log = map_shader_log(info_log(shader, false), files);
      return failure(fmt::format("{} does not compile:\n{}", name, log.empty() ? "(the driver gives no reason)" : log));
    }
    glAttachShader(program, shader);
  }
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) {
    // String numbers are only unambiguous with one stage; some drivers first complain here.
    const std::string log = info_log(program, true);
    return failure(fmt::format("{} does not link:\n{}", fmt::join(key.files, " + "),
                               key.files.size() == 1 ? map_shader_log(log, all_files) : log));
  }
  for (const auto& shader : shaders) glDetachShader(program, shader);
  // Drivers take from milliseconds to many seconds over one: whoever waits wants to know for what.
  log_debug("{} [{}] compiled in {:.2f} s", key.files.back(), fmt::join(key.defines, " "),
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  glObjectLabel(GL_PROGRAM, program, -1, key.files.back().c_str());
  return program.release();
}

}  // namespace

GLint Program::location(std::string_view uniform) const {
  if (const auto found = locations_.find(uniform); found != locations_.end()) return found->second;
  std::string name(uniform);
  const GLint at = glGetUniformLocation(id_, name.c_str());
  locations_.emplace(std::move(name), at);
  return at;
}

void Program::set(std::string_view uniform, float v) const {
  if (GLint at = location(uniform); at >= 0) glProgramUniform1f(id_, at, v);
}
void Program::set(std::string_view uniform, int v) const {
  if (GLint at = location(uniform); at >= 0) glProgramUniform1i(id_, at, v);
}
void Program::set(std::string_view uniform, unsigned v) const {
  if (GLint at = location(uniform); at >= 0) glProgramUniform1ui(id_, at, v);
}
void Program::set(std::string_view uniform, const glm::vec2& v) const {
  if (GLint at = location(uniform); at >= 0) glProgramUniform2fv(id_, at, 1, glm::value_ptr(v));
}
void Program::set(std::string_view uniform, const glm::vec3& v) const {
  if (GLint at = location(uniform); at >= 0) glProgramUniform3fv(id_, at, 1, glm::value_ptr(v));
}
void Program::set(std::string_view uniform, const glm::vec4& v) const {
  if (GLint at = location(uniform); at >= 0) glProgramUniform4fv(id_, at, 1, glm::value_ptr(v));
}
void Program::set(std::string_view uniform, const glm::ivec2& v) const {
  if (GLint at = location(uniform); at >= 0) glProgramUniform2iv(id_, at, 1, glm::value_ptr(v));
}
void Program::set(std::string_view uniform, const glm::uvec2& v) const {
  if (GLint at = location(uniform); at >= 0) glProgramUniform2uiv(id_, at, 1, glm::value_ptr(v));
}
void Program::set(std::string_view uniform, const glm::mat4& v) const {
  if (GLint at = location(uniform); at >= 0) glProgramUniformMatrix4fv(id_, at, 1, GL_FALSE, glm::value_ptr(v));
}

GLenum Program::uniform_type(std::string_view uniform) const {
  const std::string name(uniform);
  const GLuint index = glGetProgramResourceIndex(id_, GL_UNIFORM, name.c_str());
  if (index == GL_INVALID_INDEX) return 0;
  const GLenum property = GL_TYPE;
  GLint type = 0;
  glGetProgramResourceiv(id_, GL_UNIFORM, index, 1, &property, 1, nullptr, &type);
  return static_cast<GLenum>(type);
}

bool Program::set_numbers(std::string_view uniform, std::span<const double> values) const {
  const GLint at = location(uniform);
  if (at < 0) return false;
  std::array<GLfloat, 4> f{};
  std::array<GLint, 4> i{};
  std::array<GLuint, 4> u{};
  for (std::size_t k = 0; k < std::min<std::size_t>(values.size(), 4); ++k) {
    f[k] = static_cast<GLfloat>(values[k]);
    i[k] = static_cast<GLint>(std::clamp(values[k], -2147483648.0, 2147483647.0));
    u[k] = static_cast<GLuint>(std::clamp(values[k], 0.0, 4294967295.0));
  }
  const std::size_t n = values.size();
  switch (uniform_type(uniform)) {
    case GL_FLOAT:
      return n == 1 && (glProgramUniform1fv(id_, at, 1, f.data()), true);
    case GL_FLOAT_VEC2:
      return n == 2 && (glProgramUniform2fv(id_, at, 1, f.data()), true);
    case GL_FLOAT_VEC3:
      return n == 3 && (glProgramUniform3fv(id_, at, 1, f.data()), true);
    case GL_FLOAT_VEC4:
      return n == 4 && (glProgramUniform4fv(id_, at, 1, f.data()), true);
    case GL_INT:
    case GL_BOOL:
      return n == 1 && (glProgramUniform1iv(id_, at, 1, i.data()), true);
    case GL_INT_VEC2:
      return n == 2 && (glProgramUniform2iv(id_, at, 1, i.data()), true);
    case GL_INT_VEC3:
      return n == 3 && (glProgramUniform3iv(id_, at, 1, i.data()), true);
    case GL_INT_VEC4:
      return n == 4 && (glProgramUniform4iv(id_, at, 1, i.data()), true);
    case GL_UNSIGNED_INT:
      return n == 1 && (glProgramUniform1uiv(id_, at, 1, u.data()), true);
    case GL_UNSIGNED_INT_VEC2:
      return n == 2 && (glProgramUniform2uiv(id_, at, 1, u.data()), true);
    case GL_UNSIGNED_INT_VEC3:
      return n == 3 && (glProgramUniform3uiv(id_, at, 1, u.data()), true);
    case GL_UNSIGNED_INT_VEC4:
      return n == 4 && (glProgramUniform4uiv(id_, at, 1, u.data()), true);
    default:
      return false;
  }
}

void Program::dispatch(int x, int y, int z) const {
  if (x <= 0 || y <= 0 || z <= 0) return;
  use();
  const auto groups = [](int count, int size) { return static_cast<GLuint>((count + size - 1) / size); };
  glDispatchCompute(groups(x, group_size_.x), groups(y, group_size_.y), groups(z, group_size_.z));
}

struct ShaderLibrary::Entry {
  ShaderKey key;
  Program program;
  std::vector<Dependency> dependencies;
};

ShaderLibrary::ShaderLibrary() = default;
ShaderLibrary::~ShaderLibrary() = default;

void ShaderLibrary::install(Entry& entry, GLuint id) {
  Program& program = entry.program;
  program.id_ = GlId<delete_program>(id);
  program.locations_.clear();
  program.group_size_ = glm::ivec3(1);
  if (entry.key.files.size() == 1 && entry.key.files[0].ends_with(".comp.glsl")) {
    glGetProgramiv(id, GL_COMPUTE_WORK_GROUP_SIZE, glm::value_ptr(program.group_size_));
  }
}

Result<const Program*> ShaderLibrary::load(const ShaderKey& key) {
  assert(!key.files.empty());
  for (const auto& entry : entries_) {
    if (entry->key == key) return &entry->program;
  }
  auto entry = std::make_unique<Entry>();
  entry->key = key;
  auto id = build(key, entry->dependencies);
  if (!id) return tl::unexpected(id.error());
  install(*entry, *id);
  entries_.push_back(std::move(entry));
  return &entries_.back()->program;
}

std::vector<std::string> ShaderLibrary::reload_changed(bool* changed) {
  std::vector<std::string> failures;
  if (changed) *changed = false;
  for (const auto& entry : entries_) {
    if (std::none_of(entry->dependencies.begin(), entry->dependencies.end(), has_changed)) continue;
    std::vector<Dependency> dependencies;
    auto id = build(entry->key, dependencies);
    // After a failure the new stamps count all the same: try again when a file changes, not every time.
    entry->dependencies = std::move(dependencies);
    if (!id) {
      // Programs that share a broken file all say the same.
      if (std::find(failures.begin(), failures.end(), id.error().message) == failures.end()) {
        failures.push_back(id.error().message);
      }
      continue;
    }
    install(*entry, *id);
    ++generation_;
    if (changed) *changed = true;
  }
  return failures;
}

}  // namespace petrichor
