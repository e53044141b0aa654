#include "engine/gpu/formats.hpp"

namespace petrichor {
namespace {

constexpr FormatInfo kFormats[] = {
    // name, format, bytes, integer, depth, image
    {"r8", GL_R8, 1, false, false, true},
    {"rg8", GL_RG8, 2, false, false, true},
    {"rgba8", GL_RGBA8, 4, false, false, true},
    {"rgba8_snorm", GL_RGBA8_SNORM, 4, false, false, true},
    {"srgb8_alpha8", GL_SRGB8_ALPHA8, 4, false, false, false},
    {"r16", GL_R16, 2, false, false, true},
    {"rg16", GL_RG16, 4, false, false, true},
    {"rgba16", GL_RGBA16, 8, false, false, true},
    {"rg16_snorm", GL_RG16_SNORM, 4, false, false, true},
    {"r16f", GL_R16F, 2, false, false, true},
    {"rg16f", GL_RG16F, 4, false, false, true},
    {"rgba16f", GL_RGBA16F, 8, false, false, true},
    {"r32f", GL_R32F, 4, false, false, true},
    {"rg32f", GL_RG32F, 8, false, false, true},
    {"rgba32f", GL_RGBA32F, 16, false, false, true},
    {"r11f_g11f_b10f", GL_R11F_G11F_B10F, 4, false, false, true},
    {"rgb10_a2", GL_RGB10_A2, 4, false, false, true},
    {"r8ui", GL_R8UI, 1, true, false, true},
    {"r16ui", GL_R16UI, 2, true, false, true},
    {"r32ui", GL_R32UI, 4, true, false, true},
    {"rg32ui", GL_RG32UI, 8, true, false, true},
    {"rgba32ui", GL_RGBA32UI, 16, true, false, true},
    {"rgba16ui", GL_RGBA16UI, 8, true, false, true},
    {"rgba8ui", GL_RGBA8UI, 4, true, false, true},
    {"r32i", GL_R32I, 4, true, false, true},
    {"rg32i", GL_RG32I, 8, true, false, true},
    {"rgba32i", GL_RGBA32I, 16, true, false, true},
    {"depth16", GL_DEPTH_COMPONENT16, 2, false, true, false},
    {"depth24", GL_DEPTH_COMPONENT24, 4, false, true, false},
    {"depth32f", GL_DEPTH_COMPONENT32F, 4, false, true, false},
};

}  // namespace

std::span<const FormatInfo> known_formats() {
  return kFormats;
}

const FormatInfo* find_format(GLenum internal_format) {
  for (const FormatInfo& info : kFormats) {
    if (info.format == internal_format) return &info;
  }
  return nullptr;
}

const FormatInfo* find_format(std::string_view name) {
  for (const FormatInfo& info : kFormats) {
    if (info.name == name) return &info;
  }
  return nullptr;
}

}  // namespace petrichor
