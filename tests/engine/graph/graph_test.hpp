#pragma once
// Passes small enough to reason about: each resource holds one number, read from its first pixel.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/graph/graph.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {

struct Frame {
  bool rain = true;
  bool fog = true;
  bool sun = true;
};

namespace test {

inline float first_pixel(const Texture& texture) {
  std::vector<float> pixels(static_cast<std::size_t>(texture.width) * texture.height * texture.layers * 4);
  glGetTextureImage(texture.id, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(pixels.size() * 4), pixels.data());
  return pixels[0];
}

inline void fill(const Texture& texture, float value) {
  clear_texture(texture, {value, value, value, value});
}

// What the passes saw, for the tests to look at.
struct Seen {
  std::vector<std::string> order;
  std::vector<bool> flags;
  std::vector<GLuint> ids;
};

inline std::vector<PassOffer> offers(Seen& seen) {
  using enum SlotAccess;
  std::vector<PassOffer> list;
  // out = value
  list.push_back(
      {.name = "fill", .slots = {{"out", write}}, .parameters = {{"value", 1.0}}, .execute = [&](PassContext& p) {
         seen.order.push_back("fill");
         seen.ids.push_back(p.texture("out").id);
         fill(p.texture("out"), p.parameter("value"));
       }});
  // target += amount
  const auto add = [&seen](std::string name) {
    return [&seen, name](PassContext& p) {
      seen.order.push_back(name);
      fill(p.texture("target"), first_pixel(p.texture("target")) + p.parameter("amount"));
    };
  };
  list.push_back(
      {.name = "add", .slots = {{"target", modify}}, .parameters = {{"amount", 10.0}}, .execute = add("add")});
  list.push_back({.name = "rain",
                  .slots = {{"target", modify}},
                  .parameters = {{"amount", 100.0}},
                  .wanted = [](const Frame& frame) { return frame.rain; },
                  .execute = add("rain")});
  list.push_back({.name = "fog",
                  .slots = {{"mask", write}},
                  .wanted = [](const Frame& frame) { return frame.fog; },
                  .execute =
                      [&](PassContext& p) {
                        seen.order.push_back("fog");
                        fill(p.texture("mask"), 1000.0f);
                      }});
  // out = image + mask, where there is a mask
  list.push_back({.name = "mix",
                  .slots = {{"image", read}, {"mask", read, true}, {"out", write}, {"debug", write, true}},
                  .execute = [&](PassContext& p) {
                    seen.order.push_back("mix");
                    seen.flags = {p.has("mask"), p.has("debug")};
                    seen.ids.push_back(p.texture("out").id);
                    const float mask = p.has("mask") ? first_pixel(p.texture("mask")) : 0.0f;
                    fill(p.texture("out"), first_pixel(p.texture("image")) + mask);
                    if (p.has("debug")) fill(p.texture("debug"), 5.0f);
                  }});
  // out = image
  list.push_back({.name = "copy", .slots = {{"image", read}, {"out", write}}, .execute = [&](PassContext& p) {
                    seen.order.push_back("copy");
                    seen.ids.push_back(p.texture("out").id);
                    fill(p.texture("out"), first_pixel(p.texture("image")));
                  }});
  // Reads without writing anything that the graph knows of.
  list.push_back({.name = "measure", .slots = {{"image", read}}, .execute = [&](PassContext& p) {
                    seen.order.push_back("measure");
                    seen.flags = {first_pixel(p.texture("image")) > 0};
                  }});
  // A cached map: drawn anew only where it has to be.
  list.push_back({.name = "cached",
                  .slots = {{"map", write}},
                  .wanted = [](const Frame& frame) { return frame.sun; },
                  .execute =
                      [&](PassContext& p) {
                        seen.order.push_back(p.fresh("map") ? "cached anew" : "cached kept");
                        if (p.fresh("map")) fill(p.texture("map"), 77.0f);
                      }});
  return list;
}

inline nlohmann::json rgba16f(nlohmann::json more = nlohmann::json::object()) {
  more["format"] = "rgba16f";
  return more;
}

}  // namespace test
}  // namespace petrichor
