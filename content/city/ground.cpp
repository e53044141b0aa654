// Carriageways, pavements, kerbs, markings, covers and the water that stands on them.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "content/city/dice.hpp"
#include "content/city/parts.hpp"
#include "content/city/plan.hpp"

namespace petrichor::city {
namespace {

const glm::vec3 kerb_stone(0.19f, 0.185f, 0.175f);

Vertex ground_vertex(const StandingWater& water, glm::vec2 p, glm::vec2 uv, glm::vec3 tint) {
  const float e = 0.12f;
  Vertex v{};
  v.position_m = {p.x, carriageway_height_m(p.x, p.y), p.y};
  const float dx = carriageway_height_m(p.x + e, p.y) - carriageway_height_m(p.x - e, p.y);
  const float dz = carriageway_height_m(p.x, p.y + e) - carriageway_height_m(p.x, p.y - e);
  v.normal = glm::normalize(glm::vec3(-dx, 2.0f * e, -dz));
  v.uv = uv;
  v.colour = glm::min(tint, glm::vec3(1.0f));
  v.puddle_depth_m = water.depth_at(p.x, p.y);
  return v;
}

template <class Make>
void grid(Primitive& out, const std::vector<float>& xs, const std::vector<float>& zs, Make&& make) {
  const auto base = static_cast<std::uint32_t>(out.vertices.size());
  for (float z : zs) {
    for (float x : xs) out.vertices.push_back(make(x, z));
  }
  const auto w = static_cast<std::uint32_t>(xs.size());
  for (std::uint32_t j = 0; j + 1 < zs.size(); ++j) {
    for (std::uint32_t i = 0; i + 1 < w; ++i) {
      const std::uint32_t a = base + j * w + i;
      out.indices.insert(out.indices.end(), {a, a + w, a + 1, a + 1, a + w, a + w + 1});
    }
  }
}

std::vector<float> steps(float from, float to, float about) {
  const int n = std::max(1, static_cast<int>(std::lround((to - from) / about)));
  std::vector<float> out;
  for (int k = 0; k <= n; ++k) out.push_back(from + (to - from) * static_cast<float>(k) / static_cast<float>(n));
  return out;
}

// Large, slow differences of tone, so that the texture's repeats drown.
glm::vec3 street_tint(float x, float z) {
  const float a = std::sin(0.31f * x + 0.17f * z + 1.3f) * std::sin(0.11f * z - 0.23f * x) +
                  0.6f * std::sin(0.53f * z + 0.4f * std::sin(0.7f * x));
  return glm::vec3(0.86f + 0.10f * a);
}

void add_main_street(Scene& scene, const StandingWater& water, int parent) {
  const std::vector<float> half{0.0f, 0.25f, 0.5f, 0.75f, 1.0f, 1.25f, 1.5f, 1.75f, 2.0f, 2.25f,
                                2.5f, 2.8f,  3.1f, 3.4f,  3.7f, 4.0f,  4.3f, 4.65f, 5.0f};
  for (int chunk = 0; chunk < 8; ++chunk) {
    const float z0 = -street_end_m + 15.0f * static_cast<float>(chunk);
    Mesh mesh;
    mesh.name = "lamplighter_street_" + std::to_string(chunk);
    for (int side : {-1, 1}) {
      std::vector<float> xs;
      for (float x : half) xs.push_back(static_cast<float>(side) * x);
      std::sort(xs.begin(), xs.end());
      grid(mesh.primitives[Mat::asphalt], xs, steps(z0, z0 + 15.0f, 0.4f), [&](float x, float z) {
        // Each lane turned by half a turn: u runs from the crown to the kerb on both sides.
        const glm::vec2 uv(std::abs(x) / 5.0f, (side > 0 ? z : -z + 3.7f) / 10.0f);
        return ground_vertex(water, {x, z}, uv, street_tint(x, z));
      });
    }
    add_mesh_node(scene, parent, std::move(mesh));
  }
}

void add_lane(Scene& scene, const StandingWater& water, int parent) {
  std::vector<float> zs;
  for (float z : {0.0f, 0.3f, 0.6f, 0.9f, 1.2f, 1.5f, 1.8f, 2.1f, 2.4f, 2.7f, 3.0f, 3.35f, 3.7f, 4.0f}) {
    zs.push_back(z);
    if (z > 0.0f) zs.push_back(-z);
  }
  std::sort(zs.begin(), zs.end());
  for (int side : {-1, 1}) {
    for (int chunk = 0; chunk < 4; ++chunk) {
      const float near = main_half_m + 13.75f * static_cast<float>(chunk);
      const float x0 = side > 0 ? near : -near - 13.75f;
      Mesh mesh;
      mesh.name = std::string("weathercock_lane_") + (side > 0 ? "east_" : "west_") + std::to_string(chunk);
      grid(mesh.primitives[Mat::setts], steps(x0, x0 + 13.75f, 0.4f), zs, [&](float x, float z) {
        return ground_vertex(water, {x, z}, glm::vec2(z, x) / 3.0f, street_tint(x, z));
      });
      if (chunk == 0) {  // the corners between the rounded kerbs, under the pavement's edge
        for (int up : {-1, 1}) {
          std::vector<float> corner = steps(lane_half_m, lane_half_m + kerb_radius_m, 0.6f);
          for (float& z : corner) z *= static_cast<float>(up);
          std::sort(corner.begin(), corner.end());
          const float xa = side > 0 ? main_half_m : -main_half_m - kerb_radius_m;
          grid(mesh.primitives[Mat::setts], steps(xa, xa + kerb_radius_m, 0.6f), corner, [&](float x, float z) {
            return ground_vertex(water, {x, z}, glm::vec2(z, x) / 3.0f, street_tint(x, z));
          });
        }
      }
      add_mesh_node(scene, parent, std::move(mesh));
    }
  }
}

// One quadrant's pavement, built for x > 0, z > 0 and mirrored. A strip between the kerb line and the walls.
void add_pavement(Scene& scene, int sx, int sz, int parent) {
  struct Station {
    glm::vec2 kerb, wall;
  };
  std::vector<std::vector<Station>> pieces;
  const float corner_z = lane_wall_m + corner_cut_m;
  const float corner_x = main_wall_m + corner_cut_m;
  for (int k = 0; k < 3; ++k) {
    const std::vector<float> cuts = steps(corner_z, street_end_m, 16.9f);
    std::vector<Station> strip;
    for (float z : steps(cuts[static_cast<std::size_t>(k)], cuts[static_cast<std::size_t>(k) + 1], 4.3f)) {
      strip.push_back({{main_half_m, z}, {main_wall_m + 0.4f, z}});
    }
    std::reverse(strip.begin(), strip.end());
    pieces.push_back(strip);
  }
  std::vector<Station> corner{{{main_half_m, corner_z}, {main_wall_m + 0.4f, corner_z}}};
  const int arc = 10;
  for (int k = 0; k <= arc; ++k) {
    const float f = static_cast<float>(k) / static_cast<float>(arc);
    const float t = 1.5707963f * f;
    const glm::vec2 centre(main_half_m + kerb_radius_m, lane_half_m + kerb_radius_m);
    corner.push_back({centre - kerb_radius_m * glm::vec2(std::cos(t), std::sin(t)),
                      glm::mix(glm::vec2(main_wall_m + 0.4f, corner_z), glm::vec2(corner_x, lane_wall_m + 0.4f), f)});
  }
  corner.push_back({{corner_x, lane_half_m}, {corner_x, lane_wall_m + 0.4f}});
  pieces.push_back(corner);
  for (int k = 0; k < 3; ++k) {
    const std::vector<float> cuts = steps(corner_x, street_end_m, 16.4f);
    std::vector<Station> strip;
    for (float x : steps(cuts[static_cast<std::size_t>(k)], cuts[static_cast<std::size_t>(k) + 1], 4.1f)) {
      strip.push_back({{x, lane_half_m}, {x, lane_wall_m + 0.4f}});
    }
    pieces.push_back(strip);
  }
  const float kerb_width = 0.22f;
  int number = 0;
  for (const std::vector<Station>& piece : pieces) {
    Mesh mesh;
    mesh.name = std::string("pavement_") + (sz < 0 ? "n" : "s") + (sx < 0 ? "w_" : "e_") + std::to_string(number++);
    Builder b(mesh);
    const auto point = [&](glm::vec2 p, float y) {
      return glm::vec3(p.x * static_cast<float>(sx), y, p.y * static_cast<float>(sz));
    };
    const bool flipped = sx * sz > 0;
    const auto face = [&](const Paint& paint, glm::vec3 a, glm::vec3 c, glm::vec3 d, glm::vec3 e) {
      if (flipped)
        b.quad(paint, a, e, d, c);
      else
        b.quad(paint, a, c, d, e);
    };
    const Paint stone = plain(kerb_stone, Finish::stone);
    const Paint slabs = tiling(Mat::slabs, glm::vec3(0.95f));
    for (std::size_t k = 0; k + 1 < piece.size(); ++k) {
      const Station& s = piece[k];
      const Station& t = piece[k + 1];
      const glm::vec2 sd = glm::normalize(s.wall - s.kerb);
      const glm::vec2 td = glm::normalize(t.wall - t.kerb);
      const glm::vec2 si = s.kerb + sd * kerb_width;
      const glm::vec2 ti = t.kerb + td * kerb_width;
      const float ws = pavement_height_m(glm::length(s.wall - s.kerb));
      const float wt = pavement_height_m(glm::length(t.wall - t.kerb));
      face(slabs, point(si, kerb_m), point(ti, kerb_m), point(t.wall, wt), point(s.wall, ws));
      const glm::vec2 sc = s.kerb + sd * 0.03f;
      const glm::vec2 tc = t.kerb + td * 0.03f;
      face(stone, point(sc, kerb_m), point(tc, kerb_m), point(ti, kerb_m), point(si, kerb_m));
      face(stone, point(s.kerb, kerb_m - 0.03f), point(t.kerb, kerb_m - 0.03f), point(tc, kerb_m), point(sc, kerb_m));
      face(stone, point(s.kerb, -0.12f), point(t.kerb, -0.12f), point(t.kerb, kerb_m - 0.03f),
           point(s.kerb, kerb_m - 0.03f));
    }
    add_mesh_node(scene, parent, std::move(mesh));
  }
}

// A painted rectangle that follows the road's shape, 4 mm proud of it.
void paint_on_road(Mesh& mesh, const StandingWater& water, glm::vec2 low, glm::vec2 high, float cell_m,
                   glm::vec3 tint) {
  grid(mesh.primitives[Mat::markings], steps(low.x, high.x, cell_m), steps(low.y, high.y, cell_m),
       [&](float x, float z) {
         Vertex v{};
         v.position_m = {x, carriageway_height_m(x, z) + 0.006f, z};
         v.normal = {0.0f, 1.0f, 0.0f};
         v.uv = glm::vec2(x, z) * 0.37f;
         v.puddle_depth_m = water.depth_at(x, z);  // of the road: paint is thin
         v.colour = glm::min(tint, glm::vec3(1.0f));
         return v;
       });
}

void add_markings(Scene& scene, const StandingWater& water, int parent) {
  Mesh mesh;
  mesh.name = "road_markings";
  const glm::vec3 white(1.0f, 0.98f, 0.92f);
  for (int s : {-1, 1}) {
    const auto sf = static_cast<float>(s);
    for (int k = 0; k < 9; ++k) {  // zebra across the main street
      const float x = -4.4f + 1.1f * static_cast<float>(k);
      const float z = sf * 8.6f;
      paint_on_road(mesh, water, {x - 0.27f, z - 1.5f}, {x + 0.27f, z + 1.5f}, 0.55f, white);
    }
    for (int k = 0; k < 7; ++k) {  // and across the lane
      const float z = -3.3f + 1.1f * static_cast<float>(k);
      const float x = sf * 9.6f;
      paint_on_road(mesh, water, {x - 1.3f, z - 0.27f}, {x + 1.3f, z + 0.27f}, 0.55f, white);
    }
    // Stop lines, on the side that drives up to the crossing (right-hand traffic).
    paint_on_road(mesh, water, {s > 0 ? 0.15f : -4.8f, sf * 11.0f - 0.2f}, {s > 0 ? 4.8f : -0.15f, sf * 11.0f + 0.2f},
                  0.6f, white);
    for (int k = 0; k < 10; ++k) {  // middle line
      const float z = sf * (14.0f + 4.6f * static_cast<float>(k));
      paint_on_road(mesh, water, {-0.07f, std::min(z, z + sf * 2.4f)}, {0.07f, std::max(z, z + sf * 2.4f)}, 0.8f,
                    white);
    }
    for (int side : {-1, 1}) {  // parking bays
      for (int k = 0; k < 7; ++k) {
        const float z = sf * (14.5f + 6.0f * static_cast<float>(k));
        const float x = static_cast<float>(side) * 3.95f;
        paint_on_road(mesh, water, {x - 1.0f, z - 0.05f}, {x + 1.0f, z + 0.05f}, 0.7f, white * 0.9f);
      }
    }
  }
  add_mesh_node(scene, parent, std::move(mesh));
}

void add_ironwork(Scene& scene, const StandingWater& water, int parent) {
  Mesh cover;
  cover.name = "manhole";
  Builder b(cover);
  const int sides = 20;
  std::vector<glm::vec3> ring;
  for (int k = 0; k < sides; ++k) {
    const float t = 6.2831853f * static_cast<float>(k) / sides;
    ring.emplace_back(0.33f * std::sin(t), 0.0f, 0.33f * std::cos(t));
  }
  b.fan(tiling(Mat::ironwork), ring);
  for (Vertex& v : cover.primitives[Mat::ironwork].vertices)
    v.uv = glm::vec2(v.position_m.x, v.position_m.z) / 0.68f + 0.5f;
  const int cover_mesh = scene.add_mesh(std::move(cover));
  int number = 0;
  for (glm::vec2 p : {glm::vec2(1.5f, 6.0f), glm::vec2(-1.5f, -14.0f), glm::vec2(1.6f, -27.0f), glm::vec2(-1.4f, 26.0f),
                      glm::vec2(0.2f, 0.6f), glm::vec2(1.5f, 43.0f), glm::vec2(-1.5f, -45.0f), glm::vec2(15.0f, 0.1f),
                      glm::vec2(-18.0f, 0.2f), glm::vec2(36.0f, 0.0f), glm::vec2(-40.0f, -0.2f)}) {
    const float y = carriageway_height_m(p.x, p.y) + 0.007f;
    add_node(scene, "manhole_" + std::to_string(number++), parent, cover_mesh,
             glm::translate(glm::mat4(1.0f), {p.x, y, p.y}));
  }
  Mesh gully;
  gully.name = "gully";
  Builder g(gully);
  const Paint iron = plain({0.07f, 0.065f, 0.06f}, Finish::iron);
  const Paint pit = plain(glm::vec3(0.004f), Finish::gloss);
  g.quad(pit, {-0.24f, 0.0f, 0.24f}, {0.24f, 0.0f, 0.24f}, {0.24f, 0.0f, -0.24f}, {-0.24f, 0.0f, -0.24f});
  for (int k = 0; k < 7; ++k) {
    const float x = -0.24f + 0.072f * static_cast<float>(k);
    g.box(iron, {x, 0.0f, -0.25f}, {x + 0.034f, 0.018f, 0.25f}, face_all & ~(face_bottom | face_back | face_front));
  }
  g.box(iron, {-0.27f, 0.0f, 0.23f}, {0.27f, 0.02f, 0.27f}, face_no_bottom);
  g.box(iron, {-0.27f, 0.0f, -0.27f}, {0.27f, 0.02f, -0.23f}, face_no_bottom);
  const int gully_mesh = scene.add_mesh(std::move(gully));
  number = 0;
  for (const glm::vec2& p : water.gullies) {
    const float y = carriageway_height_m(p.x, p.y) + 0.004f;
    add_node(scene, "gully_" + std::to_string(number++), parent, gully_mesh,
             glm::translate(glm::mat4(1.0f), {p.x, y, p.y}));
  }
}

}  // namespace

void add_ground(Scene& scene, const StandingWater& water) {
  const int street = scene.group("street");
  add_main_street(scene, water, street);
  add_lane(scene, water, street);
  for (int sx : {-1, 1}) {
    for (int sz : {-1, 1}) add_pavement(scene, sx, sz, street);
  }
  add_markings(scene, water, street);
  add_ironwork(scene, water, street);

  const int puddles = scene.group("puddles");
  int number = 0;
  for (const Basin& basin : water.basins) {
    const glm::vec2 size = basin.maximum_m - basin.minimum_m;
    const glm::vec2 centre = 0.5f * (basin.maximum_m + basin.minimum_m);
    Node node;
    node.name = "puddle_" + std::to_string(number++);
    node.parent = puddles;
    node.translation_m = {centre.x, basin.level_m, centre.y};
    nlohmann::json extras;
    extras["puddle"] = {
        {"size_m", {size.x, size.y}},
        {"maximum_depth_mm", 1000.0f * basin.maximum_depth_m},
        {"area_share", basin.area_m2 / (size.x * size.y)},
        {"mean_depth_share", std::clamp(basin.volume_m3 / (basin.area_m2 * basin.maximum_depth_m), 0.334f, 0.5f)},
        {"catchment_ratio", basin.catchment_m2 / basin.area_m2}};
    node.extras_json = extras.dump();
    scene.add(std::move(node));
  }
}

}  // namespace petrichor::city
