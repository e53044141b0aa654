#pragma once
// A small scene made by code, drawn by the passes under test without a window.

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/graph/graph.hpp"
#include "engine/platform/context.hpp"
#include "systems/atmosphere/passes.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/geometry/passes.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/image/passes.hpp"
#include "systems/lighting/passes.hpp"
#include "systems/lighting/state.hpp"

namespace petrichor::test {

struct Look {
  glm::vec3 albedo{0.5f};
  float roughness = 1.0f;
  glm::vec3 emissive{0.0f};
};

// A box from low to high in a material of its own.
inline void add_box(Model& model, glm::vec3 low, glm::vec3 high, const Look& look) {
  Material material;
  material.base_colour = glm::vec4(look.albedo, 1.0f);
  material.metallic = 0.0f;
  material.roughness = look.roughness;
  material.emissive = look.emissive;
  Primitive p;
  p.material = static_cast<std::int32_t>(model.materials.size());
  model.materials.push_back(material);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto base = static_cast<std::uint32_t>(p.vertices.size());
      for (int corner = 0; corner < 4; ++corner) {
        Vertex vertex;
        vertex.position_m[axis] = side ? high[axis] : low[axis];
        vertex.position_m[u] = corner & 1 ? high[u] : low[u];
        vertex.position_m[v] = corner & 2 ? high[v] : low[v];
        vertex.normal = glm::vec3(0.0f);
        vertex.normal[axis] = side ? 1.0f : -1.0f;
        vertex.tangent = glm::vec4(0.0f);
        vertex.tangent[u] = 1.0f;
        vertex.tangent.w = 1.0f;
        p.vertices.push_back(vertex);
      }
      const std::uint32_t front[6] = {0, 1, 2, 2, 1, 3}, back[6] = {0, 2, 1, 2, 3, 1};
      for (const std::uint32_t i : side ? front : back) p.indices.push_back(base + i);
    }
  p.bounds_min_m = low;
  p.bounds_max_m = high;
  Node node;
  node.mesh = static_cast<std::int32_t>(model.meshes.size());
  model.nodes.push_back(node);
  model.meshes.push_back({"box", {p}});
}

inline FrameLight lamp(glm::vec3 position, float candela) {
  FrameLight light{};
  light.position_m = position;
  light.direction = {0, -1, 0};
  light.intensity = glm::vec3(candela);
  light.range_m = 1000.0f;
  light.outer_cone_rad = 0.785f;
  light.source_radius_m = 0.02f;
  light.kind = LIGHT_POINT;
  light.lights_rain = true;
  return light;
}

// The table that the tests start from: every pass, and what each writes under its own name.
inline nlohmann::json full_table() {
  return nlohmann::json::parse(R"json({
    "resources": {
      "depth": {"format": "depth32f"}, "albedo": {"format": "rgba8"}, "normal": {"format": "rgba16"},
      "emissive": {"format": "r11f_g11f_b10f"},
      "shadow_atlas": {"format": "rgba32f", "width": 2048, "height": 2048, "persistent": true},
      "environment": {"format": "rgba16f", "width": 448, "height": 65},
      "light_lists": {"format": "rgba32ui", "scale": 0.125}, "colour": {"format": "rgba16f"},
      "airlight": {"format": "rgba16f", "scale": 0.25}, "bloom": {"format": "rgba16f", "scale": 0.5, "mips": 6},
      "display": {"format": "rgba16f"}, "picture": {"format": "rgba8"}},
    "passes": [
      {"pass": "gbuffer", "depth": "depth", "albedo": "albedo", "normal": "normal", "emissive": "emissive"},
      {"pass": "shadow_maps", "shadow_atlas": "shadow_atlas"},
      {"pass": "environment", "environment": "environment", "shadow_atlas": "shadow_atlas"},
      {"pass": "light_lists", "depth": "depth", "albedo": "albedo", "normal": "normal", "shadow_atlas": "shadow_atlas", "light_lists": "light_lists"},
      {"pass": "shade", "depth": "depth", "albedo": "albedo", "normal": "normal", "emissive": "emissive",
       "light_lists": "light_lists", "shadow_atlas": "shadow_atlas", "environment": "environment", "colour": "colour"},
      {"pass": "airlight", "depth": "depth", "light_lists": "light_lists", "shadow_atlas": "shadow_atlas", "airlight": "airlight"},
      {"pass": "atmosphere", "colour": "colour", "depth": "depth", "airlight": "airlight", "environment": "environment"},
      {"pass": "bloom", "colour": "colour", "bloom": "bloom"},
      {"pass": "tonemap", "colour": "colour", "bloom": "bloom", "display": "display"},
      {"pass": "antialias", "display": "display", "picture": "picture"}],
    "output": "picture"})json");
}

inline void disable(nlohmann::json& table, std::initializer_list<const char*> names) {
  for (auto& pass : table["passes"])
    for (const char* name : names)
      if (pass["pass"] == name) pass["enabled"] = false;
}

inline nlohmann::json& pass(nlohmann::json& table, const char* name) {
  for (auto& entry : table["passes"])
    if (entry["pass"] == name) return entry;
  throw std::runtime_error(name);
}

// One running renderer over a model. Pixels are read as floats, rows from the bottom.
struct Stage {
  explicit Stage(const Model& model, int width = 128, int height = 96) {
    state = std::make_shared<LightingState>();
    std::vector<PassOffer> offers;
    for (auto some : {geometry_passes(), lighting_passes(state), atmosphere_passes(), image_passes()})
      offers.insert(offers.end(), some.begin(), some.end());
    graph = std::make_unique<Graph>(shaders, offers);
    scene.add(model);
    frame.scene = &scene;
    frame.width = width;
    frame.height = height;
    frame.geometry_version = frame.lights_version = 1;
    frame.camera.bloom = 0.0f;
    frame.camera.exposure_ev100 = 3.0f;
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
      frame.instances.push_back({0, static_cast<std::uint32_t>(model.nodes[i].mesh), true, glm::mat4(1.0f)});
  }

  void look(glm::vec3 eye, glm::vec3 at) {
    const glm::vec3 back = glm::normalize(eye - at);
    const glm::vec3 aside = std::abs(back.y) > 0.99f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
    const glm::vec3 right = glm::normalize(glm::cross(aside, back));
    frame.camera.position_m = eye;
    frame.camera.orientation = glm::quat_cast(glm::mat3(right, glm::cross(back, right), back));
  }

  std::vector<glm::vec4> draw(const nlohmann::json& table, const std::string& output) {
    nlohmann::json named = table;
    named["output"] = output;
    if (named != loaded) {
      auto done = graph->load_table(named, "test");
      EXPECT_TRUE(done) << (done ? "" : done.error().message);
      loaded = named;
    }
    finish_frame(frame);
    gpu.upload(frame);
    timer.begin_frame(false);
    auto drawn = graph->execute(frame, frame.width, frame.height, timer);
    timer.end_frame();
    EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message);
    if (!drawn) return {};
    width = (*drawn)->width;
    height = (*drawn)->height;
    std::vector<glm::vec4> pixels(static_cast<std::size_t>(width * height));
    glGetTextureImage((*drawn)->id, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(pixels.size() * sizeof(glm::vec4)),
                      pixels.data());
    EXPECT_EQ(gl_error_count(), 0) << last_gl_error();
    return pixels;
  }

  glm::vec3 centre(const std::vector<glm::vec4>& pixels) const {
    return glm::vec3(pixels[static_cast<std::size_t>(height / 2 * width + width / 2)]);
  }

  ShaderLibrary shaders;
  std::shared_ptr<LightingState> state;
  std::unique_ptr<Graph> graph;
  GpuScene scene;
  FrameGpu gpu;
  FrameTimer timer{true};
  Frame frame;
  nlohmann::json loaded;
  int width = 0, height = 0;
};

}  // namespace petrichor::test
