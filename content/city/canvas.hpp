#pragma once
// Procedural pictures that repeat: periodic noise, a height field that becomes a normal map, and encoding.

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace petrichor::city {

struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  // row-major from the top
  Picture() = default;
  Picture(int w, int h) : width(w), height(h), rgb(static_cast<std::size_t>(w) * h * 3) {}
  std::uint8_t* at(int x, int y) { return &rgb[(static_cast<std::size_t>(y) * width + x) * 3]; }
};

// What a material's maps say at one point. Albedo is linear; height in metres, up out of the surface.
struct Texel {
  glm::vec3 albedo{0.5f};
  float roughness = 0.5f;
  float metalness = 0.0f;
  float height_m = 0.0f;
};

struct Maps {
  Picture base_colour;          // sRGB
  Picture roughness_metalness;  // R relief, G roughness, B metalness
  Picture normal;
};

// Evaluates texel(u, v) over [0,1)^2, v downwards; normals by central differences with wrap-around. relief_m: height
// that R spans, 0.5 being height_m = 0; 0: R is 1.
Maps paint_maps(int width, int height, glm::vec2 metres, float relief_m, const std::function<Texel(float u, float v)>& texel);

// Gradient noise in [-1, 1] that repeats after period cells in x and y.
float periodic_noise(glm::vec2 p, glm::ivec2 period, std::uint32_t seed);
// Sum of octaves over [0,1)^2, starting at `cells` periods across; roughly [-1, 1].
float periodic_fbm(float u, float v, glm::ivec2 cells, int octaves, std::uint32_t seed);

float to_srgb(float linear);
std::uint8_t to_byte(float value);

// File bytes; `format` is "jpg" or "png". Empty where the codec is missing.
std::vector<std::uint8_t> encode(const Picture&, const std::string& format);

}  // namespace petrichor::city
