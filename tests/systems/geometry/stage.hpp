#pragma once
// A headless stage for tests of what is drawn: one context for the program, a scene, the real frame graph with a
// probe at its end that reads every texture of a table back.

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>

#include "engine/graph/graph.hpp"
#include "engine/platform/context.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor::test {

inline Context* stage_context() { return shared_gl_context(); }

struct Pixels {
  int width = 0, height = 0, channels = 0;
  std::vector<float> values;
  const float* at(int x, int y) const { return &values[static_cast<std::size_t>((y * width + x) * channels)]; }
};

// Reads the named slots (and runs although nobody reads it).
inline PassOffer probe_offer(std::vector<std::string> names, std::map<std::string, Pixels>* out) {
  PassOffer offer;
  offer.name = "probe";
  for (const std::string& name : names) offer.slots.push_back({name, SlotAccess::read});
  offer.side_effect = true;
  offer.execute = [names, out](PassContext& context) {
    for (const std::string& name : names) {
      const Texture& texture = context.texture(name);
      Pixels& p = (*out)[name];
      const bool depth = texture.format == GL_DEPTH_COMPONENT32F;
      p = {texture.width, texture.height, depth ? 1 : 4, {}};
      p.values.resize(static_cast<std::size_t>(p.width * p.height * p.channels));
      glGetTextureImage(texture.id, 0, depth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT,
                        static_cast<GLsizei>(p.values.size() * sizeof(float)), p.values.data());
    }
  };
  return offer;
}

// The scene of a test; draw() runs `table` over `offers` and keeps what the probe saw.
struct Stage {
  ShaderLibrary shaders;
  GpuScene scene;
  FrameGpu gpu;
  FrameTimer timer{true};
  std::map<std::string, Pixels> pixels;
  std::unique_ptr<Graph> graph;
  Frame frame;

  Stage(std::vector<PassOffer> offers, const std::vector<std::string>& probed, const nlohmann::json& table) {
    offers.push_back(probe_offer(probed, &pixels));
    graph = std::make_unique<Graph>(shaders, std::move(offers));
    const Result<void> loaded = graph->load_table(table, "test");
    EXPECT_TRUE(loaded) << (loaded ? "" : loaded.error().message);
    frame.width = 160;
    frame.height = 90;
    frame.camera.near_m = 0.05f;
    frame.scene = &scene;
  }

  void draw() {
    const int errors = gl_error_count();
    finish_frame(frame);
    gpu.upload(frame);
    timer.begin_frame(false);
    const auto done = graph->execute(frame, frame.width, frame.height, timer);
    timer.end_frame();
    ASSERT_TRUE(done) << done.error().message;
    glFinish();
    EXPECT_EQ(gl_error_count(), errors) << last_gl_error();
    ++frame.number;
  }
};

inline nlohmann::json gbuffer_table() {
  return nlohmann::json::parse(R"({
    "resources": {"depth": {"format": "depth32f"}, "albedo": {"format": "rgba8"}, "normal": {"format": "rgba16"},
                  "emissive": {"format": "r11f_g11f_b10f"}},
    "passes": [
      {"pass": "gbuffer", "depth": "depth", "albedo": "albedo", "normal": "normal", "emissive": "emissive"},
      {"pass": "probe", "depth": "depth", "albedo": "albedo", "normal": "normal", "emissive": "emissive"}],
    "output": "albedo"})");
}
inline const std::vector<std::string> gbuffer_names{"depth", "albedo", "normal", "emissive"};

inline Primitive& bound(Primitive& p) {
  p.bounds_min_m = glm::vec3(1e30f);
  p.bounds_max_m = glm::vec3(-1e30f);
  for (const Vertex& v : p.vertices) {
    p.bounds_min_m = glm::min(p.bounds_min_m, v.position_m);
    p.bounds_max_m = glm::max(p.bounds_max_m, v.position_m);
  }
  return p;
}

// A quad a, a+u, a+u+v, a+v, facing u x v.
inline void add_quad(Primitive& p, glm::vec3 a, glm::vec3 u, glm::vec3 v) {
  const auto first = static_cast<std::uint32_t>(p.vertices.size());
  const glm::vec3 n = glm::normalize(glm::cross(u, v));
  const glm::vec4 t(glm::normalize(u), 1.0f);
  const glm::vec3 corners[4] = {a, a + u, a + u + v, a + v};
  const glm::vec2 uvs[4] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  for (int i = 0; i < 4; ++i) p.vertices.push_back({corners[i], n, t, uvs[i], uvs[i], glm::vec4(1.0f)});
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(first + i);
}

// Facing outwards.
inline Primitive box(glm::vec3 low, glm::vec3 high, int material) {
  Primitive p;
  const glm::vec3 d = high - low;
  const glm::vec3 x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
  add_quad(p, low + z, x, y);
  add_quad(p, low + x, -x, y);
  add_quad(p, low, z, y);
  add_quad(p, low + x + z, -z, y);
  add_quad(p, low + y + z, x, -z);
  add_quad(p, low, x, z);
  p.material = material;
  bound(p);
  return p;
}

inline Material coloured(glm::vec3 colour) {
  Material m;
  m.base_colour = glm::vec4(colour, 1.0f);
  m.metallic = 0.0f;
  m.roughness = 0.5f;
  return m;
}

inline FrameInstance placed(std::uint32_t model, std::uint32_t mesh, const glm::mat4& matrix) {
  return {model, mesh, true, matrix};
}

}  // namespace petrichor::test
