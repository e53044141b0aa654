// The bus shelter: glass roof and back, a bench, a poster lit from behind.
#include <glm/gtc/matrix_transform.hpp>

#include "content/city/atlases.hpp"
#include "content/city/furniture.hpp"
#include "content/city/plan.hpp"

namespace petrichor::city {

void add_bus_shelter(Scene& scene) {
  const int parent = scene.group("bus_shelter");
  const float width = 4.2f;
  const float depth = 1.45f;
  const float high = 2.55f;
  const glm::mat4 frame = wall_frame({main_wall_m - 0.75f, pavement_height_m(2.0f), 15.2f}, {-1, 0, 0});
  Mesh mesh;
  mesh.name = "bus_shelter";
  Builder b(mesh);
  const Paint steel = plain(glm::vec3(0.07f, 0.08f, 0.08f), Finish::iron);
  const Paint glass{Mat::glass, glm::vec3(1.0f), {}};
  const int bays = 3;
  for (int k = 0; k <= bays; ++k) {
    const float x = width * static_cast<float>(k) / bays;
    b.box(steel, {x - 0.035f, 0.0f, -0.035f}, {x + 0.035f, high, 0.035f}, face_no_bottom);
    // Roof ribs, falling towards the back.
    const float y0 = high, y1 = high + 0.16f;
    b.quad(steel, {x - 0.03f, y0 + 0.05f, 0}, {x - 0.03f, y1 + 0.05f, depth}, {x + 0.03f, y1 + 0.05f, depth},
           {x + 0.03f, y0 + 0.05f, 0});
    b.quad(steel, {x - 0.03f, y0 - 0.04f, 0}, {x - 0.03f, y1 - 0.02f, depth}, {x - 0.03f, y1 + 0.05f, depth},
           {x - 0.03f, y0 + 0.05f, 0});
    b.quad(steel, {x + 0.03f, y0 + 0.05f, 0}, {x + 0.03f, y1 + 0.05f, depth}, {x + 0.03f, y1 - 0.02f, depth},
           {x + 0.03f, y0 - 0.04f, 0});
  }
  for (float x : {0.0f, width})
    b.cylinder(steel, {x, 0, depth - 0.12f}, {x, high + 0.12f, depth - 0.12f}, 0.035f, 0.035f, 8);
  b.box(steel, {0, high - 0.06f, -0.04f}, {width, high + 0.05f, 0.04f});
  b.box(steel, {-0.05f, high + 0.09f, depth - 0.05f}, {width + 0.05f, high + 0.21f, depth}, face_all);
  for (int k = 0; k < bays; ++k) {
    const float x0 = width * static_cast<float>(k) / bays + 0.05f;
    const float x1 = width * static_cast<float>(k + 1) / bays - 0.05f;
    b.quad(glass, {x0, high + 0.20f, depth}, {x1, high + 0.20f, depth}, {x1, high + 0.06f, 0}, {x0, high + 0.06f, 0});
    b.quad(glass, {x0, 0.25f, 0}, {x1, 0.25f, 0}, {x1, high - 0.1f, 0}, {x0, high - 0.1f, 0});
    mark_pane(scene, parent, frame * glm::translate(glm::mat4(1.0f), {0.5f * (x0 + x1), 0.5f * (high + 0.15f), 0.0f}),
              {x1 - x0, high - 0.35f});
    const glm::mat4 lying = glm::rotate(glm::translate(glm::mat4(1.0f), {0.5f * (x0 + x1), high + 0.13f, 0.5f * depth}),
                                        -1.5707963f - 0.097f, glm::vec3(1, 0, 0));
    mark_pane(scene, parent, frame * lying, {x1 - x0, depth});
  }
  mark_drip(scene, parent, frame * glm::translate(glm::mat4(1.0f), {0.0f, high + 0.05f, -0.02f}), width, depth, 2.0f);
  mark_drip(scene, parent, frame * glm::translate(glm::mat4(1.0f), {0.0f, high + 0.09f, depth}), width, 0.1f, 1.5f);
  // Bench of slats.
  const Paint wood = plain({0.16f, 0.08f, 0.035f}, Finish::gloss);
  for (int k = 0; k < 4; ++k)
    b.box(wood, {0.5f, 0.44f, 0.14f + 0.10f * static_cast<float>(k)},
          {2.9f, 0.475f, 0.22f + 0.10f * static_cast<float>(k)}, face_no_bottom);
  for (float x : {0.7f, 2.7f})
    b.box(steel, {x - 0.03f, 0, 0.15f}, {x + 0.03f, 0.44f, 0.5f}, face_all & ~(face_top | face_bottom));
  // Poster case across the right-hand end.
  const float px = width;
  const float z0 = 0.12f, z1 = 1.22f, y0 = 0.35f, y1 = 2.05f;
  b.box(steel, {px - 0.08f, y0 - 0.1f, z0 - 0.07f}, {px + 0.08f, y1 + 0.1f, z1 + 0.07f});
  b.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::poster_concert), {px + 0.083f, y0, z1}, {px + 0.083f, y0, z0},
            {px + 0.083f, y1, z0}, {px + 0.083f, y1, z1});
  b.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::poster_sea), {px - 0.083f, y0, z0}, {px - 0.083f, y0, z1},
            {px - 0.083f, y1, z1}, {px - 0.083f, y1, z0});
  // A strip light under the roof, and the stop's flag.
  b.box(glow(Glow::strip), {0.4f, high - 0.06f, 0.10f}, {width - 0.4f, high - 0.03f, 0.14f});
  b.cylinder(steel, {-0.9f, 0, depth - 0.1f}, {-0.9f, 3.0f, depth - 0.1f}, 0.03f, 0.03f, 8, false, true);
  const float fx = -0.9f;
  for (float side : {-1.0f, 1.0f}) {
    const float x = fx + side * 0.036f;
    const float za = depth - 0.1f - 0.4f * 1.0f, zb = depth - 0.1f + 0.0f;
    if (side > 0)
      b.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::bus_stop), {x, 2.6f, zb + 0.25f}, {x, 2.6f, za},
                {x, 2.92f, za}, {x, 2.92f, zb + 0.25f});
    else
      b.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::bus_stop), {x, 2.6f, za}, {x, 2.6f, zb + 0.25f},
                {x, 2.92f, zb + 0.25f}, {x, 2.92f, za});
  }
  add_mesh_node(scene, parent, std::move(mesh), frame);
  const auto at = [&](glm::vec3 p) { return glm::vec3(frame * glm::vec4(p, 1.0f)); };
  add_light(scene, "bus_shelter_strip", parent, at({0.5f * width, high - 0.2f, 0.35f}),
            {{0.92f, 1.0f, 0.97f}, 85.0f, 14.0f, 0, 0, true, 0.5f});
  add_light(scene, "bus_shelter_poster", parent, at({width + 0.5f, 1.2f, 0.65f}),
            {{0.80f, 0.72f, 0.75f}, 26.0f, 8.0f, 0, 0, false, 0.5f});
}

}  // namespace petrichor::city
