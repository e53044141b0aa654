#pragma once
// The texture formats a render script may name, and what follows from each.

#include <epoxy/gl.h>

#include <span>
#include <string_view>

namespace petrichor {

struct FormatInfo {
  std::string_view name;  // "rgba16f", as in GLSL's image layout qualifiers
  GLenum format;          // GL_RGBA16F
  int bytes_per_pixel;
  bool integer;  // fetched as ivec4 or uvec4, never filtered
  bool depth;
  bool image;  // may be bound for image load and store (OpenGL 4.5 core, table 8.26)
};

std::span<const FormatInfo> known_formats();
const FormatInfo* find_format(GLenum internal_format);  // null: unknown here
const FormatInfo* find_format(std::string_view name);

}  // namespace petrichor
