// Neon and plates on the walls: the colours of the town's night.
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "content/city/atlases.hpp"
#include "content/city/furniture.hpp"
#include "content/city/lettering.hpp"
#include "content/city/neon.hpp"
#include "content/city/plan.hpp"

namespace petrichor::city {
namespace {

// A board standing out from the wall with the same tubes on both faces.
template <class Face>
void blade(Builder b, float y0, float y1, float reach, glm::vec3 colour, Face&& face) {
  const Paint board = plain(colour, Finish::paint);
  const Paint iron = plain(glm::vec3(0.03f), Finish::iron);
  b.box(board, {-0.09f, y0, 0.25f}, {0.09f, y1, 0.25f + reach});
  for (float y : {y0 + 0.25f, y1 - 0.25f})
    b.box(iron, {-0.03f, y - 0.03f, 0.0f}, {0.03f, y + 0.03f, 0.25f}, face_no_back);
  // Faces look along local +x and -x; on each, x runs across the board from its left as one reads it.
  face(b.at(glm::translate(glm::mat4(1.0f), {0.09f, 0.0f, 0.25f + reach}) *
            glm::rotate(glm::mat4(1.0f), 1.5707963f, glm::vec3(0, 1, 0))));
  face(b.at(glm::translate(glm::mat4(1.0f), {-0.09f, 0.0f, 0.25f}) *
            glm::rotate(glm::mat4(1.0f), -1.5707963f, glm::vec3(0, 1, 0))));
}

std::vector<glm::vec3> frame_line(float x0, float x1, float y0, float y1, float corner) {
  return {{x0 + corner, y0, 0.05f}, {x1 - corner, y0, 0.05f}, {x1, y0 + corner, 0.05f}, {x1, y1 - corner, 0.05f},
          {x1 - corner, y1, 0.05f}, {x0 + corner, y1, 0.05f}, {x0, y1 - corner, 0.05f}, {x0, y0 + corner, 0.05f}};
}

std::vector<glm::vec3> arc_line(glm::vec2 centre, float radius, float from_deg, float to_deg, int pieces) {
  std::vector<glm::vec3> out;
  for (int k = 0; k <= pieces; ++k) {
    const float t = glm::radians(from_deg + (to_deg - from_deg) * static_cast<float>(k) / static_cast<float>(pieces));
    out.emplace_back(centre.x + radius * std::cos(t), centre.y + radius * std::sin(t), 0.05f);
  }
  return out;
}

}  // namespace

void add_wall_signs(Scene& scene) {
  const int parent = scene.group("wall_signs");
  Mesh mesh;
  mesh.name = "neon_signs";
  Builder world(mesh);
  const auto light = [&](const std::string& name, const glm::mat4& frame, glm::vec3 p, glm::vec3 colour, float candela,
                         float range) {
    add_light(scene, name, parent, glm::vec3(frame * glm::vec4(p, 1.0f)), {colour, candela, range, 0, 0, false, 0.5f});
  };

  // HOTEL, down the west side of the main street.
  const glm::mat4 hotel = wall_frame({-main_wall_m, 0, -22.5f}, {1, 0, 0});
  blade(world.at(hotel), 5.4f, 11.3f, 1.05f, {0.02f, 0.012f, 0.03f}, [&](Builder b) {
    neon_column(b, Glow::neon_pink, "HOTEL", 0.525f, 11.0f, 0.82f, 1.10f, 0.026f);
    neon_line(b, Glow::neon_blue, frame_line(0.07f, 0.98f, 5.47f, 11.23f, 0.14f), 0.016f, true);
  });
  for (float s : {-1.0f, 1.0f})
    light(s < 0 ? "hotel_neon_north" : "hotel_neon_south", hotel, {s * 0.9f, 7.6f, 0.9f}, {1.0f, 0.16f, 0.46f}, 120.0f,
          20.0f);

  // Café Luna: a moon and letters on the cut corner over the door.
  const glm::mat4 cafe = wall_frame({-main_wall_m - corner_cut_m, 0, -lane_wall_m}, glm::normalize(glm::vec3(1, 0, 1)));
  {
    Builder b = world.at(cafe).moved({0, 0, 0.22f});
    const float h = 0.44f;
    const float width = neon_width("CAFE", 0.08f) * h;
    neon_text(b, Glow::neon_cyan, "CAFE", 2.12f - 0.5f * width, 4.42f, h, 0.018f, 0.08f);
    neon_line(b, Glow::neon_amber, arc_line({3.42f, 4.72f}, 0.34f, 70.0f, 290.0f, 14), 0.016f);
    neon_line(b, Glow::neon_amber, arc_line({3.57f, 4.72f}, 0.30f, 85.0f, 275.0f, 12), 0.016f);
    light("cafe_neon", cafe, {2.1f, 4.4f, 0.9f}, {0.12f, 0.92f, 1.0f}, 65.0f, 14.0f);
  }

  // The pharmacy's cross.
  const glm::mat4 cross = wall_frame({main_wall_m, 0, 10.6f}, {-1, 0, 0});
  blade(world.at(cross), 4.55f, 5.65f, 1.1f, {0.012f, 0.03f, 0.018f}, [&](Builder b) {
    for (float r : {0.50f, 0.36f}) {
      const float w = r * 0.38f;
      const float y = 5.1f;
      const float x = 0.55f;
      const std::array<glm::vec3, 12> line{{{x - w, y - r, 0.05f},
                                            {x + w, y - r, 0.05f},
                                            {x + w, y - w, 0.05f},
                                            {x + r, y - w, 0.05f},
                                            {x + r, y + w, 0.05f},
                                            {x + w, y + w, 0.05f},
                                            {x + w, y + r, 0.05f},
                                            {x - w, y + r, 0.05f},
                                            {x - w, y + w, 0.05f},
                                            {x - r, y + w, 0.05f},
                                            {x - r, y - w, 0.05f},
                                            {x - w, y - w, 0.05f}}};
      neon_line(b, Glow::neon_green, line, 0.016f, true);
    }
  });
  light("pharmacy_cross_light", cross, {0.8f, 5.0f, 1.1f}, {0.10f, 1.0f, 0.25f}, 55.0f, 13.0f);

  // A bar down the lane, another on the south of the main street.
  const glm::mat4 bar = wall_frame({-25.0f, 0, lane_wall_m}, {0, 0, -1});
  blade(world.at(bar), 4.4f, 7.3f, 0.75f, {0.02f, 0.012f, 0.012f}, [&](Builder b) {
    neon_column(b, Glow::neon_red, "BAR", 0.375f, 7.1f, 0.68f, 0.88f, 0.022f);
    neon_line(b, Glow::neon_amber, frame_line(0.05f, 0.70f, 4.46f, 7.24f, 0.10f), 0.014f, true);
  });
  light("bar_neon", bar, {0.0f, 5.2f, 1.5f}, {1.0f, 0.12f, 0.06f}, 80.0f, 16.0f);
  const glm::mat4 rooms = wall_frame({main_wall_m, 0, 33.5f}, {-1, 0, 0});
  blade(world.at(rooms), 4.6f, 8.4f, 0.85f, {0.012f, 0.012f, 0.03f}, [&](Builder b) {
    neon_column(b, Glow::neon_cyan, "CLUB", 0.425f, 8.2f, 0.70f, 0.92f, 0.022f);
    neon_line(b, Glow::neon_pink, frame_line(0.06f, 0.79f, 4.66f, 8.34f, 0.12f), 0.014f, true);
  });
  light("club_neon", rooms, {0.0f, 5.8f, 1.6f}, {0.15f, 0.85f, 1.0f}, 80.0f, 16.0f);
  const glm::mat4 wine = wall_frame({31.0f, 0, -lane_wall_m}, {0, 0, 1});
  blade(world.at(wine), 4.4f, 7.9f, 0.75f, {0.03f, 0.01f, 0.02f}, [&](Builder b) {
    neon_column(b, Glow::neon_amber, "WINE", 0.375f, 7.7f, 0.64f, 0.84f, 0.02f);
    neon_line(b, Glow::neon_red, frame_line(0.05f, 0.70f, 4.46f, 7.84f, 0.10f), 0.014f, true);
  });
  light("wine_neon", wine, {0.0f, 5.4f, 1.5f}, {1.0f, 0.42f, 0.08f}, 80.0f, 16.0f);

  // The hotel at the end of the street, over its door.
  const glm::mat4 meteor = wall_frame({main_wall_m, 0, street_end_m}, {0, 0, -1});
  {
    Builder b = world.at(meteor).moved({0, 0, 0.25f});
    const float h = 0.55f;
    const float width = neon_width("HOTEL", 0.1f) * h;
    neon_text(b, Glow::neon_red, "HOTEL", main_wall_m - 0.5f * width, 4.35f, h, 0.02f, 0.1f);
    light("hotel_end_neon", meteor, {main_wall_m, 4.3f, 1.2f}, {1.0f, 0.12f, 0.06f}, 70.0f, 14.0f);
  }

  // Street names on the corners.
  for (int sx : {-1, 1}) {
    for (int sz : {-1, 1}) {
      const auto fx = static_cast<float>(sx);
      const auto fz = static_cast<float>(sz);
      Builder a =
          world.at(wall_frame({fx * main_wall_m, 3.95f, fz * (lane_wall_m + corner_cut_m + 9.4f)}, {-fx, 0, 0}));
      a.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::street_main), {-0.45f, -0.09f, 0.03f},
                {0.45f, -0.09f, 0.03f}, {0.45f, 0.09f, 0.03f}, {-0.45f, 0.09f, 0.03f});
      Builder c =
          world.at(wall_frame({fx * (main_wall_m + corner_cut_m + 9.4f), 3.95f, fz * lane_wall_m}, {0, 0, -fz}));
      c.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::street_cross), {-0.45f, -0.09f, 0.03f},
                {0.45f, -0.09f, 0.03f}, {0.45f, 0.09f, 0.03f}, {-0.45f, 0.09f, 0.03f});
    }
  }
  add_mesh_node(scene, parent, std::move(mesh));
}

}  // namespace petrichor::city
