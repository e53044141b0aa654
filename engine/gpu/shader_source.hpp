#pragma once
// GLSL text before the driver sees it: includes, defines, #version, and the way back from the driver's
// "string 2, line 14" to file and line.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace petrichor {

struct SourceFile {
  std::string name;            // as asked for: "systems/drops/field.comp.glsl"
  std::filesystem::path path;  // on disk; empty: not found
};

struct ShaderSource {
  std::string text;
  std::vector<SourceFile> files;  // index = the source string number that #line gives
};

// Reads a shader and all it includes.
//  - `#include "path"`: against the data roots, then beside the including file. A file is taken in once; a cycle is an
//    error. `#include <...>` and whatever stands in #ifdef __cplusplus is for C++ and left out.
//  - `#version 450 core` is put in where the main file has none; defines ("NAME" is 1, or "NAME value") follow it.
// Errors name file:line. `files` (may be null) receives the files touched also where reading fails.
Result<ShaderSource> read_shader(std::string_view name, std::span<const std::string> defines,
                                 std::vector<SourceFile>* files = nullptr);

// Rewrites a driver's log, each message to "file:line: ...". Knows Mesa's "0:12(5): ", NVIDIA's "0(12) : " and
// "ERROR: 0:12: " of others.
std::string map_shader_log(std::string_view log, std::span<const SourceFile> files);

}  // namespace petrichor
