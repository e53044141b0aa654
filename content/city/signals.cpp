// Traffic lights at the crossing, and what hangs over the streets.
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "content/city/furniture.hpp"
#include "content/city/plan.hpp"
#include "content/city/toys.hpp"

namespace petrichor::city {
namespace {

void signal_head(Builder b, bool red) {
  const Paint black = plain(glm::vec3(0.012f), Finish::paint);
  b.box(black, {-0.15f, 0.0f, -0.12f}, {0.15f, 0.92f, 0.08f});
  for (int k = 0; k < 3; ++k) {  // green below, amber, red on top
    const float y = 0.17f + 0.29f * static_cast<float>(k);
    const bool on = (k == 2 && red) || (k == 0 && !red);
    const Paint lens = on ? glow(red ? Glow::signal_red : Glow::signal_green)
                          : plain(k == 2   ? glm::vec3(0.05f, 0.004f, 0.003f)
                                  : k == 1 ? glm::vec3(0.05f, 0.03f, 0.002f)
                                           : glm::vec3(0.003f, 0.04f, 0.02f),
                                  Finish::gloss);
    b.cylinder(lens, {0, y, 0.07f}, {0, y, 0.10f}, 0.105f, 0.07f, 12, false, true);
    for (int s = 0; s < 6; ++s) {  // visor: the upper half of a tube, seen from both sides
      const float t0 = 3.14159265f * static_cast<float>(s) / 6.0f;
      const float t1 = 3.14159265f * static_cast<float>(s + 1) / 6.0f;
      const auto on_visor = [&](float t, float z) {
        return glm::vec3(0.125f * std::cos(t), y + 0.125f * std::sin(t), z);
      };
      b.quad(black, on_visor(t0, 0.08f), on_visor(t0, 0.30f), on_visor(t1, 0.30f), on_visor(t1, 0.08f));
      b.quad(black, on_visor(t0, 0.30f), on_visor(t0, 0.08f), on_visor(t1, 0.08f), on_visor(t1, 0.30f));
    }
  }
}

Mesh signal_mesh(bool red) {
  Mesh mesh;
  mesh.name = red ? "traffic_light_red" : "traffic_light_green";
  Builder b(mesh);
  const Paint grey = plain(glm::vec3(0.06f), Finish::iron);
  b.cylinder(grey, {0, 0, 0}, {0, 3.3f, 0}, 0.065f, 0.055f, 9, false, true);
  b.cylinder(grey, {0, 0, 0}, {0, 0.35f, 0}, 0.11f, 0.10f, 9, false, true);
  signal_head(b.moved({0.0f, 2.30f, 0.16f}), red);
  return mesh;
}

std::vector<glm::vec3> catenary(glm::vec3 a, glm::vec3 c, float sag_m, int pieces) {
  std::vector<glm::vec3> out;
  for (int k = 0; k <= pieces; ++k) {
    const float t = static_cast<float>(k) / static_cast<float>(pieces);
    out.push_back(glm::mix(a, c, t) - glm::vec3(0.0f, 4.0f * sag_m * t * (1.0f - t), 0.0f));
  }
  return out;
}

}  // namespace

void add_signals(Scene& scene) {
  const int parent = scene.group("traffic_lights");
  const int red = scene.add_mesh(signal_mesh(true));
  const int green = scene.add_mesh(signal_mesh(false));
  struct Place {
    glm::vec2 at;
    glm::vec3 facing;
    bool red;
  };
  const std::array<Place, 4> places{{{{5.4f, 10.7f}, {0, 0, 1}, true},
                                     {{-5.4f, -10.7f}, {0, 0, -1}, true},
                                     {{-11.3f, 4.5f}, {-1, 0, 0}, false},
                                     {{11.3f, -4.5f}, {1, 0, 0}, false}}};
  int number = 0;
  for (const Place& p : places) {
    const std::string name = "traffic_light_" + std::to_string(number++);
    const glm::mat4 frame = wall_frame({p.at.x, kerb_m, p.at.y}, p.facing);
    add_node(scene, name, parent, p.red ? red : green, frame);
    const float y = p.red ? 3.05f : 2.47f;
    add_light(scene, name + "_light", parent, glm::vec3(frame * glm::vec4(0, y, 0.62f, 1)),
              {p.red ? glm::vec3(1.0f, 0.04f, 0.02f) : glm::vec3(0.05f, 1.0f, 0.45f), p.red ? 34.0f : 26.0f, 16.0f, 0,
               0, false, 0.1f});
  }
}

void add_wires(Scene& scene) {
  const int parent = scene.group("wires");
  const Paint wire = plain(glm::vec3(0.012f), Finish::rubber);
  const float high = 6.6f;
  const std::array<float, 6> spans{{-52.0f, -33.0f, -13.0f, 12.5f, 31.0f, 52.0f}};
  Mesh mesh;
  mesh.name = "overhead_wires";
  Builder b(mesh);
  for (float z : spans) {  // span wires from wall to wall
    b.tube(wire, catenary({-main_wall_m, high, z}, {main_wall_m, high + 0.2f, z}, 0.45f, 8), 0.010f, 3);
    for (float x : {-main_wall_m, main_wall_m})
      b.cylinder(plain(glm::vec3(0.04f), Finish::iron), {x, high, z}, {x - std::copysign(0.12f, x), high, z}, 0.05f,
                 0.02f, 6);
    mark_drip(scene, parent, glm::translate(glm::mat4(1.0f), {-3.0f, high - 0.38f, z}), 6.0f, 0.02f, 1.0f);
  }
  for (std::size_t k = 0; k + 1 < spans.size(); ++k) {  // the trolley bus's two pairs
    for (float x : {-1.75f, -1.15f, 1.15f, 1.75f}) {
      const float y = high - 0.42f;
      b.tube(wire, catenary({x, y, spans[k]}, {x, y, spans[k + 1]}, 0.18f, 6), 0.008f, 3);
      b.cylinder(wire, {x, y, spans[k]}, {x, y + 0.12f, spans[k]}, 0.03f, 0.02f, 5);
    }
  }
  add_mesh_node(scene, parent, std::move(mesh));

  // Strings of bulbs over the lane, by the toy shop and the café.
  Mesh bulbs;
  bulbs.name = "festoons";
  Builder f(bulbs);
  int number = 0;
  for (float x : {13.5f, 18.5f, 23.5f, -13.0f, -18.0f, -23.0f}) {
    const float skew = x > 0 ? 2.2f : -2.2f;
    const auto line = catenary({x, 5.6f, -lane_wall_m}, {x + skew, 5.9f, lane_wall_m}, 0.9f, 14);
    f.tube(wire, line, 0.008f, 3);
    for (std::size_t k = 1; k + 1 < line.size(); ++k) {
      f.cylinder(wire, line[k] - glm::vec3(0, 0.05f, 0), line[k], 0.018f, 0.014f, 4);
      f.cylinder(glow(Glow::candle), line[k] - glm::vec3(0, 0.09f, 0), line[k] - glm::vec3(0, 0.045f, 0), 0.036f,
                 0.024f, 5);
      f.cylinder(glow(Glow::candle), line[k] - glm::vec3(0, 0.125f, 0), line[k] - glm::vec3(0, 0.09f, 0), 0.008f,
                 0.036f, 5);
    }
    if (number % 3 != 2)
      add_light(scene, "festoon_light_" + std::to_string(number), parent, line[7] - glm::vec3(0, 0.2f, 0),
                {{1.0f, 0.60f, 0.24f}, 60.0f, 15.0f, 0, 0, false, 0.6f});
    ++number;
  }
  add_mesh_node(scene, parent, std::move(bulbs));
}

}  // namespace petrichor::city
