#include "systems/lighting/chosen_lights.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "systems/frame_gpu.hpp"

namespace petrichor {
namespace {

constexpr float longest_reach_m = 60.0f;

float strongest(const FrameLight& light) {
  return std::max({light.intensity.x, light.intensity.y, light.intensity.z});
}

LightGpu relative_light(const FrameLight& light, const Frame& frame, int slot) {
  const glm::vec3 position(glm::dvec3(light.position_m) - frame.camera.position_m);
  const bool spot = light.kind == LIGHT_SPOT;
  const float inner = std::cos(std::min(light.inner_cone_rad, light.outer_cone_rad));
  const float outer = std::cos(light.outer_cone_rad);
  // KHR_lights_punctual, "Inner and Outer Cone Angles". A point light's scale 0 and offset 1 pass everything.
  const float scale = spot ? 1.0f / std::max(0.001f, inner - outer) : 0.0f;
  const float offset = spot ? -outer * scale : 1.0f;
  return {glm::vec4(position, light_range_m(light, frame.camera.exposure_ev100)),
          glm::vec4(light.intensity, std::max(light.source_radius_m, 0.005f)),
          glm::vec4(light.direction, static_cast<float>(light.kind)),
          glm::vec4(scale, offset, static_cast<float>(slot), shadow_reach_m(light))};
}

struct Fnv {  // Fowler, Noll, Vo, 64 bits, 1a
  std::uint64_t hash = 14695981039346656037ull;
  void add(std::uint32_t word) { hash = (hash ^ word) * 1099511628211ull; }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  void add(const glm::vec3& v) { add(v.x), add(v.y), add(v.z); }
};

}  // namespace

float shadow_reach_m(const FrameLight& light) {
  return light.range_m > 0.0f ? std::min(light.range_m, longest_reach_m) : longest_reach_m;
}

std::vector<std::size_t> shadow_casters(const Frame& frame) {
  std::vector<std::size_t> casters;
  for (std::size_t i = 0; i < frame.lights.size(); ++i) {
    const FrameLight& light = frame.lights[i];
    if (light.casts_shadow && light.kind != LIGHT_DIRECTIONAL && strongest(light) > 0.0f) casters.push_back(i);
  }
  if (casters.size() <= MAXIMUM_SHADOWS) return casters;
  const glm::dvec3 near = glm::round(frame.camera.position_m / 8.0) * 8.0;
  const auto distance = [&](std::size_t i) { return glm::length(glm::dvec3(frame.lights[i].position_m) - near); };
  std::stable_sort(casters.begin(), casters.end(), [&](auto a, auto b) { return distance(a) < distance(b); });
  casters.resize(MAXIMUM_SHADOWS);
  std::sort(casters.begin(), casters.end());
  return casters;
}

ChosenLights choose_lights(const Frame& frame, std::span<const int> shadow_slots) {
  const auto slot = [&](std::size_t i) { return i < shadow_slots.size() ? shadow_slots[i] : -1; };
  std::vector<std::size_t> order;
  std::vector<float> weight(frame.lights.size());
  for (std::size_t i = 0; i < frame.lights.size(); ++i) {
    const FrameLight& light = frame.lights[i];
    if (!(strongest(light) > 0.0f)) continue;
    const glm::dvec3 away = glm::dvec3(light.position_m) - frame.camera.position_m;
    const float squared = static_cast<float>(glm::dot(away, away));
    weight[i] = light.kind == LIGHT_DIRECTIONAL ? 1e30f : strongest(light) / std::max(squared, 1.0f);
    order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) {
    if ((slot(a) >= 0) != (slot(b) >= 0)) return slot(a) >= 0;
    return weight[a] > weight[b];
  });
  if (order.size() > MAXIMUM_LIGHTS) order.resize(MAXIMUM_LIGHTS);

  ChosenLights chosen{};
  for (const std::size_t i : order) {
    if (slot(i) >= 0) ++chosen.counts.y;
    chosen.lights[chosen.counts.x++] = relative_light(frame.lights[i], frame, slot(i));
  }
  return chosen;
}

std::uint64_t lighting_hash(const Frame& frame) {
  Fnv f;
  for (const FrameLight& light : frame.lights) {
    f.add(light.position_m), f.add(light.direction), f.add(light.intensity);
    f.add(light.range_m), f.add(light.inner_cone_rad), f.add(light.outer_cone_rad), f.add(light.source_radius_m);
    f.add(static_cast<std::uint32_t>(light.kind)), f.add(light.casts_shadow ? 1u : 0u);
  }
  f.add(frame.sky.zenith_cd_m2), f.add(frame.sky.horizon_cd_m2), f.add(frame.sky.glow_height);
  return f.hash;
}

}  // namespace petrichor
