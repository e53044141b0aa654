// Street lamps: cast-iron posts and wall brackets.
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "content/city/furniture.hpp"
#include "content/city/plan.hpp"

namespace petrichor::city {
namespace {

const glm::vec3 cast_iron(0.022f, 0.026f, 0.025f);

// A four-sided lantern with its top at y = 0, glass 0.5 m high.
void lantern(Builder b, Glow colour) {
  const Paint iron = plain(cast_iron, Finish::iron);
  const float top = 0.20f, low = 0.12f, h = 0.46f;
  for (int k = 0; k < 4; ++k) {
    Builder side = b.moved({0, 0, 0}, 1.5707963f * static_cast<float>(k));
    side.quad(glow(colour), {-low, -h, low}, {low, -h, low}, {top, 0, top}, {-top, 0, top});
    side.cylinder(iron, {-low, -h, low}, {-top, 0, top}, 0.014f, 0.014f, 4);
    side.triangle(iron, {-top - 0.05f, 0, top + 0.05f}, {top + 0.05f, 0, top + 0.05f}, {0, 0.20f, 0});
    side.quad(iron, {-top - 0.05f, 0.0f, top + 0.05f}, {-top, 0.0f, top - 0.02f}, {top, 0.0f, top - 0.02f},
              {top + 0.05f, 0.0f, top + 0.05f});
  }
  b.cylinder(iron, {0, -h - 0.05f, 0}, {0, -h, 0}, 0.08f, 0.17f, 8, true);
  b.cylinder(iron, {0, 0.18f, 0}, {0, 0.34f, 0}, 0.035f, 0.012f, 6);
}

Mesh post_mesh(Glow colour) {
  Mesh mesh;
  mesh.name = "lamp_post";
  Builder b(mesh);
  const Paint iron = plain(cast_iron, Finish::iron);
  const std::array<glm::vec2, 13> shaft{{{0.045f, 4.22f},
                                         {0.05f, 3.5f},
                                         {0.085f, 3.46f},
                                         {0.085f, 3.38f},
                                         {0.055f, 3.34f},
                                         {0.065f, 1.25f},
                                         {0.10f, 1.20f},
                                         {0.11f, 1.10f},
                                         {0.075f, 1.02f},
                                         {0.10f, 0.55f},
                                         {0.15f, 0.42f},
                                         {0.17f, 0.12f},
                                         {0.21f, 0.0f}}};
  b.lathe(iron, shaft, 10);
  for (float s : {-1.0f, 1.0f})
    b.cylinder(iron, {0, 3.42f, 0}, {s * 0.42f, 3.42f, 0}, 0.016f, 0.012f, 5);  // the ladder bar
  lantern(b.moved({0, 4.72f, 0}), colour);
  return mesh;
}

Mesh bracket_mesh(Glow colour) {
  Mesh mesh;
  mesh.name = "lamp_bracket";
  Builder b(mesh);
  const Paint iron = plain(cast_iron, Finish::iron);
  b.box(iron, {-0.07f, -0.55f, 0.0f}, {0.07f, 0.35f, 0.05f}, face_no_back);
  std::vector<glm::vec3> arm;
  for (int k = 0; k <= 8; ++k) {
    const float t = static_cast<float>(k) / 8.0f;
    arm.emplace_back(0.0f, 0.2f + 0.42f * std::sin(2.4f * t), 0.05f + 1.1f * t);
  }
  b.tube(iron, arm, 0.022f, 6);
  std::vector<glm::vec3> scroll;
  for (int k = 0; k <= 10; ++k) {
    const float t = static_cast<float>(k) / 10.0f;
    const float r = 0.22f * (1.0f - 0.7f * t);
    scroll.emplace_back(0.0f, -0.05f + r * std::cos(5.5f * t), 0.32f + r * std::sin(5.5f * t));
  }
  b.tube(iron, scroll, 0.013f, 5);
  b.cylinder(iron, {0, 0.27f, 1.15f}, {0, 0.48f, 1.15f}, 0.012f, 0.012f, 5);
  lantern(b.moved({0, 0.06f, 1.15f}), colour);
  return mesh;
}

}  // namespace

void add_lamps(Scene& scene) {
  const int parent = scene.group("street_lamps");
  const int post_sodium = scene.add_mesh(post_mesh(Glow::sodium));
  const int post_white = scene.add_mesh(post_mesh(Glow::white));
  const int bracket_sodium = scene.add_mesh(bracket_mesh(Glow::sodium));
  int number = 0;
  const auto post = [&](float x, float z, bool white, float candela, bool shadow) {
    const float y = pavement_height_m(0.6f);
    const std::string name = "lamp_" + std::to_string(number++);
    add_node(scene, name, parent, white ? post_white : post_sodium, glm::translate(glm::mat4(1.0f), {x, y, z}));
    add_light(scene, name + "_light", parent, {x, y + 4.48f, z},
              {white ? white_light : sodium_light, candela, 30.0f, 48.0f, white ? 0.0f : 86.0f, shadow, 0.12f});
  };
  const auto bracket = [&](glm::vec3 wall, glm::vec3 out, float candela, bool shadow) {
    const std::string name = "wall_lamp_" + std::to_string(number++);
    const glm::mat4 frame = wall_frame(wall, out);
    add_node(scene, name, parent, bracket_sodium, frame);
    add_light(scene, name + "_light", parent, glm::vec3(frame * glm::vec4(0, -0.15f, 1.15f, 1)),
              {sodium_light, candela, 26.0f, 0, 0, shadow, 0.12f});
  };
  const float kerb_x = main_half_m + 0.6f;
  // Their caps keep the light off the upper floors: a wide spot that points down. Staggered along Lamplighter Street;
  // the ones near the crossing cast shadows.
  post(-kerb_x, 13.5f, false, 400.0f, true);
  post(kerb_x, 24.5f, false, 400.0f, true);
  post(-kerb_x, 36.0f, false, 380.0f, false);
  post(kerb_x, 48.0f, true, 260.0f, false);
  post(kerb_x, -15.0f, false, 400.0f, true);
  post(-kerb_x, -25.5f, false, 400.0f, true);
  post(kerb_x, -36.5f, false, 380.0f, false);
  post(-kerb_x, -48.0f, true, 260.0f, false);
  post(-6.6f, -5.9f, true, 280.0f, true);  // the two at the crossing are whiter
  post(6.6f, 5.9f, true, 280.0f, true);
  // Brackets in the lane.
  bracket({17.5f, 4.6f, -lane_wall_m}, {0, 0, 1}, 210.0f, true);
  bracket({28.0f, 4.6f, lane_wall_m}, {0, 0, -1}, 210.0f, true);
  bracket({40.5f, 4.6f, -lane_wall_m}, {0, 0, 1}, 210.0f, false);
  bracket({52.0f, 4.6f, lane_wall_m}, {0, 0, -1}, 210.0f, false);
  bracket({-18.5f, 4.6f, lane_wall_m}, {0, 0, -1}, 210.0f, true);
  bracket({-30.0f, 4.6f, -lane_wall_m}, {0, 0, 1}, 210.0f, false);
  bracket({-42.0f, 4.6f, lane_wall_m}, {0, 0, -1}, 210.0f, false);
  bracket({-53.0f, 4.6f, -lane_wall_m}, {0, 0, 1}, 210.0f, false);
}

}  // namespace petrichor::city
