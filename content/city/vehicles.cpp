#include "content/city/vehicles.hpp"

#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "content/city/parts.hpp"
#include "content/city/plan.hpp"

namespace petrichor::city {
namespace {

void head_lights(Scene& scene, int parent, const std::string& name, const glm::mat4& frame, const CarShape& shape,
                 bool shadow) {
  const auto at = [&](glm::vec3 p) { return glm::vec3(frame * glm::vec4(p, 1.0f)); };
  const glm::vec3 beam = glm::normalize(glm::mat3(frame) * glm::vec3(0.03f, -0.11f, 1.0f));
  const float front = 0.5f * shape.length_m;
  for (float x : {-0.52f, 0.52f}) {
    add_light(scene, name + (x < 0 ? "_head_right" : "_head_left"), parent, at({x, 0.58f, front + 0.08f}),
              {{1.0f, 0.88f, 0.68f}, 1100.0f, 32.0f, 5.0f, 20.0f, shadow && x < 0, 0.08f}, beam);
    add_light(scene, name + (x < 0 ? "_tail_right" : "_tail_left"), parent, at({x, 0.60f, -front - 0.12f}),
              {{1.0f, 0.035f, 0.02f}, 7.0f, 9.0f, 0, 0, false, 0.07f});
  }
}

}  // namespace

void add_vehicles(Scene& scene) {
  const int parent = scene.group("vehicles");
  const CarShape saloon;
  CarShape small;
  small.length_m = 3.35f;
  small.half_width_m = 0.72f;
  small.height_m = 1.40f;
  small.screen_foot = 0.20f;
  small.roof_front = 0.06f;
  small.roof_back = -0.22f;
  small.rear_foot = -0.43f;
  small.tail_m = 0.62f;
  CarShape van;
  van.length_m = 4.25f;
  van.half_width_m = 0.82f;
  van.height_m = 1.86f;
  van.bonnet_m = 0.98f;
  van.nose_m = 0.74f;
  van.boot_m = 0.95f;
  van.tail_m = 0.86f;
  van.screen_foot = 0.27f;
  van.roof_front = 0.15f;
  van.roof_back = -0.42f;
  van.rear_foot = -0.485f;

  struct Kind {
    CarShape shape;
    int mesh;
  };
  const auto kind = [&](const std::string& name, const CarShape& shape, glm::vec3 colour, bool on = false,
                        CarSign sign = CarSign::none) {
    return Kind{shape, scene.add_mesh(car_mesh(name, shape, colour, on, sign))};
  };
  const std::array<Kind, 6> kinds{
      {kind("saloon_green", saloon, {0.02f, 0.07f, 0.05f}), kind("saloon_cream", saloon, {0.42f, 0.37f, 0.27f}),
       kind("small_red", small, {0.26f, 0.015f, 0.015f}), kind("small_blue", small, {0.05f, 0.13f, 0.22f}),
       kind("van_grey", van, {0.12f, 0.13f, 0.14f}), kind("saloon_plum", saloon, {0.055f, 0.012f, 0.022f})}};
  const Kind taxi_on = kind("taxi_lit", saloon, {0.012f, 0.012f, 0.014f}, true, CarSign::taxi);
  const Kind small_on = kind("small_lit", small, {0.30f, 0.20f, 0.05f}, true);

  const auto place = [&](const Kind& k, const std::string& name, glm::vec2 p, float heading) {
    const float y = carriageway_height_m(p.x, p.y);
    const glm::mat4 frame =
        glm::rotate(glm::translate(glm::mat4(1.0f), {p.x, y - 0.01f, p.y}), heading, glm::vec3(0, 1, 0));
    const int node = add_node(scene, name, parent, k.mesh, frame);
    mark_probe(scene, node, {0.0f, 0.5f * k.shape.height_m, 0.0f}, 0.56f * k.shape.length_m);
    return frame;
  };
  constexpr float north = 3.14159265f;
  constexpr float south = 0.0f;
  struct Parked {
    int kind;
    glm::vec2 at;
    float heading;
  };
  const std::array<Parked, 12> parked{{{2, {3.98f, 28.2f}, north + 0.02f},
                                       {0, {3.95f, 34.4f}, north},
                                       {4, {3.92f, 46.3f}, north - 0.02f},
                                       {1, {3.95f, -20.4f}, north + 0.015f},
                                       {3, {4.0f, -32.6f}, north},
                                       {5, {-3.95f, 17.6f}, south},
                                       {3, {-3.98f, 29.6f}, south - 0.03f},
                                       {1, {-3.95f, 41.2f}, south},
                                       {4, {-3.92f, -20.6f}, south + 0.02f},
                                       {2, {-4.0f, -27.0f}, south},
                                       {0, {-3.95f, -44.8f}, south},
                                       {5, {3.95f, -50.4f}, north}}};
  for (std::size_t k = 0; k < parked.size(); ++k) {
    place(kinds[static_cast<std::size_t>(parked[k].kind)], "parked_car_" + std::to_string(k), parked[k].at,
          parked[k].heading);
  }
  place(kinds[2], "lane_car_0", {-24.0f, 3.05f}, 1.5707963f);
  place(kinds[0], "lane_car_1", {33.0f, -3.05f}, -1.5707963f);
  // Two with their lights on: one waits at the crossing, tail towards the south; one comes down from the north.
  head_lights(scene, parent, "waiting_taxi", place(taxi_on, "waiting_taxi", {1.75f, 13.9f}, north + 0.01f), saloon,
              false);
  const glm::mat4 coming = place(small_on, "coming_car", {-1.8f, -19.0f}, south - 0.02f);
  head_lights(scene, parent, "coming_car", coming, small, true);
  // Its front wheels push standing water aside: side by side with it in the tree, as its lamps are.
  for (const float side : {-1.0f, 1.0f}) {
    const glm::vec3 foot(side * (small.half_width_m - 0.09f), 0.0f, 0.31f * small.length_m);
    mark_wader(scene, add_node(scene, side < 0.0f ? "coming_car_wheel_right" : "coming_car_wheel_left", parent, -1,
                               coming * glm::translate(glm::mat4(1.0f), foot)),
               0.12f, 10.0f);
  }
}

}  // namespace petrichor::city
