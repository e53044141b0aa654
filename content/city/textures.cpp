#include "content/city/textures.hpp"

#include <algorithm>
#include <cmath>

#include "content/city/dice.hpp"

namespace petrichor::city {
namespace {

float smooth(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

float bump(float x, float centre, float width) {
  const float d = (x - centre) / width;
  return std::exp(-d * d);
}

float blend(float a, float b, float t) {
  return a + (b - a) * t;
}
glm::vec3 blend(glm::vec3 a, glm::vec3 b, float t) {
  return a + (b - a) * t;
}

// One stone of a running bond: which stone, where in it, how far from the joint.
struct Bond {
  std::uint32_t id;
  float edge_m;  // distance to the nearest edge of the stone, negative in the joint
  float fx, fy;  // position inside, 0..1
};

// Courses of `rows` per repeat, `columns` stones each, shifted by half (or at random) from course to course.
Bond running_bond(glm::vec2 p, glm::vec2 metres, int columns, int rows, float joint_m, float jitter, std::uint32_t seed,
                  bool random_shift) {
  const float row_f = p.y * static_cast<float>(rows);
  const int row = static_cast<int>(std::floor(row_f));
  const int wrapped_row = ((row % rows) + rows) % rows;
  const float shift =
      random_shift ? unit(mix(seed, static_cast<std::uint32_t>(wrapped_row))) : 0.5f * (wrapped_row & 1);
  const float col_f = p.x * static_cast<float>(columns) + shift;
  const int col = static_cast<int>(std::floor(col_f));
  const auto edge_at = [&](int c) {
    const int w = ((c % columns) + columns) % columns;
    return static_cast<float>(c) +
           jitter *
               (unit(mix(seed + 7, static_cast<std::uint32_t>(wrapped_row), static_cast<std::uint32_t>(w))) - 0.5f);
  };
  int stone = col;
  if (col_f < edge_at(col)) stone = col - 1;
  if (col_f >= edge_at(col + 1)) stone = col + 1;
  const float left = edge_at(stone);
  const float right = edge_at(stone + 1);
  const glm::vec2 size(metres.x / static_cast<float>(columns), metres.y / static_cast<float>(rows));
  const float dx = std::min(col_f - left, right - col_f) * size.x;
  const float fy = row_f - static_cast<float>(row);
  const float dy = std::min(fy, 1.0f - fy) * size.y;
  const int w = ((stone % columns) + columns) % columns;
  return {mix(seed + 13, static_cast<std::uint32_t>(wrapped_row), static_cast<std::uint32_t>(w)),
          std::min(dx, dy) - 0.5f * joint_m, (col_f - left) / (right - left), fy};
}

// Cellular noise: the aggregate of asphalt. Returns (distance to the nearest grain, its random value).
glm::vec2 grains(float u, float v, glm::ivec2 cells, std::uint32_t seed) {
  const float x = u * static_cast<float>(cells.x);
  const float y = v * static_cast<float>(cells.y);
  const int ix = static_cast<int>(std::floor(x));
  const int iy = static_cast<int>(std::floor(y));
  glm::vec2 best(9.0f, 0.0f);
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const int cx = (ix + i + cells.x) % cells.x;
      const int cy = (iy + j + cells.y) % cells.y;
      const std::uint32_t h = mix(seed, static_cast<std::uint32_t>(cx), static_cast<std::uint32_t>(cy));
      const float dx = static_cast<float>(ix + i) + unit(h) - x;
      const float dy = static_cast<float>(iy + j) + unit(mix(h)) - y;
      const float d = dx * dx + dy * dy;
      if (d < best.x) best = {d, unit(mix(h, 5))};
    }
  }
  return {std::sqrt(best.x), best.y};
}

}  // namespace

Maps asphalt_maps() {
  const glm::vec2 metres = texture_metres(Mat::asphalt);
  return paint_maps(1024, 2048, metres, texture_relief_m(Mat::asphalt), [&](float u, float v) {
    const float across = u * metres.x;  // from the middle of the road
    const glm::vec2 grain = grains(u, v, {330, 660}, 3);
    const float large = periodic_fbm(u, v, {2, 4}, 5, 11);
    const float fine = periodic_fbm(u, v, {48, 96}, 3, 12);
    const float tracks = bump(across, 0.75f, 0.28f) + bump(across, 2.25f, 0.28f);
    const float drip = bump(across, 1.5f, 0.25f) + 0.9f * bump(across, 4.1f, 0.5f);  // oil between the wheels
    const float oil = drip * smooth(0.05f, 0.5f, periodic_fbm(u, v, {5, 9}, 3, 21));
    // A repaired trench: newer, darker, with tar joints.
    const float px = std::abs(across - 3.55f) - 0.42f + 0.02f * fine;
    const float pv = std::abs(v - 0.63f) * metres.y - 1.7f + 0.02f * fine;
    const float patch_edge = std::max(px, pv);
    const float patch = smooth(0.02f, -0.02f, patch_edge);
    const float tar = bump(patch_edge, 0.0f, 0.035f);
    const float crack_field = std::abs(periodic_fbm(u + 0.03f * fine, v, {3, 6}, 4, 31));
    const float crack = smooth(0.016f, 0.004f, crack_field) *
                        smooth(-0.05f, 0.2f, periodic_noise({u * 3, v * 5}, {3, 5}, 41)) * (1.0f - patch);
    const float longitudinal = bump(across, 3.02f + 0.02f * large, 0.012f);  // the joint between two paver passes
    Texel t;
    const float stone = smooth(0.62f, 0.2f, grain.x);
    float albedo = 0.036f + 0.035f * grain.y * stone + 0.012f * large + 0.008f * fine;
    albedo *= 1.0f - 0.25f * patch;
    albedo = blend(albedo, 0.05f, 0.25f * tracks);
    albedo *= (1.0f - 0.45f * oil) * (1.0f - 0.7f * crack) * (1.0f - 0.6f * longitudinal);
    albedo = blend(albedo, 0.012f, 0.85f * tar);
    t.albedo = std::clamp(albedo, 0.008f, 0.12f) * glm::vec3(1.0f, 0.985f, 0.96f);
    t.roughness = 0.86f - 0.10f * tracks - 0.2f * oil - 0.3f * tar + 0.04f * fine;
    t.roughness = std::clamp(t.roughness, 0.12f, 0.95f);
    t.height_m = (0.0022f * stone * (0.4f + 0.6f * grain.y) + 0.0012f * fine) - 0.004f * crack - 0.003f * longitudinal +
                 0.002f * tar + 0.004f * large;
    return t;
  });
}

Maps setts_maps() {
  const glm::vec2 metres = texture_metres(Mat::setts);
  return paint_maps(1024, 1024, metres, texture_relief_m(Mat::setts), [&](float u, float v) {
    // Segmental arcs: courses bowed across the road, three arcs a repeat.
    const float arc = std::abs(std::sin(u * 3.0f * 3.14159265f));
    const float warp = periodic_fbm(u, v, {6, 6}, 2, 5) * 0.008f;
    const Bond b = running_bond({u + warp, v + 0.055f * arc + warp}, metres, 27, 30, 0.012f, 0.45f, 77, true);
    const float large = periodic_fbm(u, v, {2, 2}, 4, 6);
    const float fine = periodic_fbm(u, v, {40, 40}, 3, 7);
    const float value = unit(b.id);
    const float hue = unit(mix(b.id, 3));
    const float crown = smooth(-0.004f, 0.028f, b.edge_m + 0.003f * fine);
    Texel t;
    const glm::vec3 granite = blend(glm::vec3(0.115f, 0.105f, 0.10f), glm::vec3(0.10f, 0.085f, 0.075f), hue);
    t.albedo = granite * (0.55f + 0.75f * value) * (1.0f + 0.35f * fine + 0.25f * large);
    t.albedo = blend(glm::vec3(0.035f, 0.032f, 0.026f), t.albedo, crown);
    t.roughness = blend(0.95f, 0.62f + 0.2f * value, crown);
    const float tilt = (b.fx - 0.5f) * (unit(mix(b.id, 5)) - 0.5f) + (b.fy - 0.5f) * (unit(mix(b.id, 6)) - 0.5f);
    t.height_m = 0.014f * crown + 0.006f * (value - 0.5f) * crown + 0.009f * tilt * crown + 0.0016f * fine;
    return t;
  });
}

Maps slabs_maps() {
  const glm::vec2 metres = texture_metres(Mat::slabs);
  return paint_maps(1024, 1024, metres, 0.0f, [&](float u, float v) {
    const float fine = periodic_fbm(u, v, {64, 64}, 3, 17);
    const float large = periodic_fbm(u, v, {3, 3}, 5, 16);
    const Bond b = running_bond({u + 0.0006f * fine, v}, metres, 5, 8, 0.009f, 0.3f, 91, true);
    const float value = unit(b.id);
    const float face = smooth(-0.003f, 0.006f, b.edge_m);
    const float gum =
        smooth(0.28f, 0.2f, grains(u, v, {24, 24}, 19).x) * (grains(u, v, {24, 24}, 19).y > 0.75f ? 1.0f : 0.0f);
    Texel t;
    t.albedo = blend(glm::vec3(0.17f, 0.16f, 0.145f), glm::vec3(0.13f, 0.128f, 0.125f), unit(mix(b.id, 2)));
    t.albedo *= 0.72f + 0.45f * value + 0.25f * fine + 0.3f * large;
    t.albedo = blend(glm::vec3(0.035f), t.albedo, face) * (1.0f - 0.45f * gum);
    t.roughness = 0.78f + 0.1f * fine;
    const float tilt = (b.fx - 0.5f) * (unit(mix(b.id, 5)) - 0.5f) + (b.fy - 0.5f) * (unit(mix(b.id, 6)) - 0.5f);
    t.height_m = 0.005f * face + 0.003f * (value - 0.5f) * face + 0.006f * tilt * face + 0.001f * fine * face;
    return t;
  });
}

Maps brick_maps() {
  const glm::vec2 metres = texture_metres(Mat::brick);
  return paint_maps(1024, 1024, metres, 0.0f, [&](float u, float v) {
    const float fine = periodic_fbm(u, v, {48, 48}, 3, 27);
    const float large = periodic_fbm(u, v, {2, 2}, 4, 26);
    const Bond b = running_bond({u + 0.0008f * fine, v + 0.0006f * fine}, metres, 8, 26, 0.011f, 0.06f, 101, false);
    const float value = unit(b.id);
    const float face = smooth(-0.002f, 0.004f, b.edge_m);
    Texel t;
    glm::vec3 clay = blend(glm::vec3(0.26f, 0.105f, 0.065f), glm::vec3(0.20f, 0.09f, 0.07f), unit(mix(b.id, 2)));
    if (unit(mix(b.id, 9)) > 0.9f) clay = glm::vec3(0.10f, 0.065f, 0.06f);  // burnt headers
    clay *= 0.7f + 0.55f * value + 0.3f * fine + 0.25f * large;
    t.albedo = blend(glm::vec3(0.21f, 0.19f, 0.165f) * (1.0f + 0.3f * large), clay, face);
    t.roughness = 0.85f + 0.12f * fine + 0.1f * (1.0f - face);
    t.height_m = 0.005f * face + 0.002f * (value - 0.5f) * face + 0.0012f * fine;
    return t;
  });
}

Maps stucco_maps() {
  const glm::vec2 metres = texture_metres(Mat::stucco);
  return paint_maps(512, 512, metres, 0.0f, [&](float u, float v) {
    const float fine = periodic_fbm(u, v, {60, 60}, 2, 37);
    const float large = periodic_fbm(u, v, {2, 2}, 5, 36);
    const float streaks = periodic_fbm(u, v, {26, 2}, 3, 38);  // rain marks running down
    const float flaked = smooth(0.50f, 0.56f, periodic_fbm(u, v, {3, 3}, 5, 39));
    Texel t;
    t.albedo = glm::vec3(0.62f) * (1.0f + 0.16f * large + 0.10f * streaks + 0.06f * fine);
    t.albedo = blend(t.albedo, glm::vec3(0.33f, 0.30f, 0.27f), 0.6f * flaked);
    t.roughness = 0.85f + 0.08f * fine;
    t.height_m = 0.0012f * fine + 0.004f * large - 0.002f * flaked;
    return t;
  });
}

Maps ashlar_maps() {
  const glm::vec2 metres = texture_metres(Mat::ashlar);
  return paint_maps(512, 512, metres, 0.0f, [&](float u, float v) {
    const float fine = periodic_fbm(u, v, {40, 40}, 3, 47);
    const float large = periodic_fbm(u, v, {2, 2}, 5, 46);
    const Bond b = running_bond({u, v}, metres, 3, 6, 0.02f, 0.12f, 121, false);
    const float face = smooth(-0.006f, 0.016f, b.edge_m);
    const float streaks = periodic_fbm(u, v, {20, 2}, 3, 48);
    Texel t;
    t.albedo =
        glm::vec3(0.46f, 0.43f, 0.375f) * (0.78f + 0.3f * unit(b.id) + 0.15f * fine + 0.2f * large + 0.12f * streaks);
    t.albedo = blend(glm::vec3(0.16f, 0.145f, 0.12f), t.albedo, face);
    t.roughness = 0.8f + 0.1f * fine;
    t.height_m = 0.016f * face + 0.0015f * fine;
    return t;
  });
}

Maps tile_maps() {
  const glm::vec2 metres = texture_metres(Mat::tiles);
  return paint_maps(512, 512, metres, 0.0f, [&](float u, float v) {
    const float fine = periodic_fbm(u, v, {40, 40}, 2, 57);
    const float large = periodic_fbm(u, v, {2, 2}, 4, 56);
    const int rows = 9;
    const int columns = 11;
    const float row_f = v * rows;
    const int row = static_cast<int>(row_f);
    const float fy = row_f - static_cast<float>(row);  // 0 at the upper edge of the course, 1 at its lip
    const float col_f = u * columns + 0.5f * (row & 1);
    const float fx = col_f - std::floor(col_f);
    const std::uint32_t id =
        mix(131, static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(static_cast<int>(col_f) % columns));
    const float lip = smooth(1.0f, 0.9f, fy + 0.10f * (2.0f * fx - 1.0f) * (2.0f * fx - 1.0f));
    const float gap = smooth(0.0f, 0.05f, std::min(fx, 1.0f - fx));
    Texel t;
    t.albedo = blend(glm::vec3(0.17f, 0.075f, 0.05f), glm::vec3(0.09f, 0.06f, 0.05f), unit(mix(id, 2))) *
               (0.6f + 0.6f * unit(id) + 0.4f * fine + 0.35f * large);
    t.albedo *= (0.35f + 0.65f * lip) * (0.5f + 0.5f * gap);
    t.roughness = 0.75f + 0.12f * fine;
    t.height_m = 0.018f * fy * lip + 0.004f * gap + 0.008f * std::sin(3.14159f * fx) + 0.001f * fine;
    return t;
  });
}

Maps marking_maps() {
  return paint_maps(512, 512, {1.0f, 1.0f}, 0.0f, [&](float u, float v) {
    const float fine = periodic_fbm(u, v, {60, 60}, 3, 67);
    const float wear = smooth(0.18f, 0.5f, periodic_fbm(u, v, {4, 4}, 5, 66) + 0.25f * fine);
    Texel t;
    t.albedo = blend(glm::vec3(0.50f, 0.49f, 0.45f) * (1.0f + 0.15f * fine), glm::vec3(0.05f), 0.9f * wear);
    t.roughness = blend(0.55f, 0.8f, wear);
    t.height_m = 0.001f * fine;
    return t;
  });
}

Maps ironwork_maps() {
  return paint_maps(256, 256, {0.7f, 0.7f}, 0.0f, [&](float u, float v) {
    const float x = (u - 0.5f) * 2.0f;
    const float y = (v - 0.5f) * 2.0f;
    const float r = std::sqrt(x * x + y * y);
    const float fine = periodic_fbm(u, v, {24, 24}, 3, 87);
    const float cell_x = u * 12.0f - std::floor(u * 12.0f) - 0.5f;
    const float cell_y = v * 12.0f - std::floor(v * 12.0f) - 0.5f;
    const float stud = smooth(0.42f, 0.3f, std::max(std::abs(cell_x), std::abs(cell_y))) * smooth(0.80f, 0.76f, r);
    const float ring = bump(r, 0.86f, 0.03f) + bump(r, 0.97f, 0.03f);
    const float raised = std::min(1.0f, stud + ring);
    Texel t;
    t.albedo = blend(glm::vec3(0.05f, 0.04f, 0.033f), glm::vec3(0.16f, 0.15f, 0.14f), raised) * (1.0f + 0.5f * fine);
    t.roughness = 0.5f + 0.15f * fine - 0.05f * raised;
    t.metalness = 0.7f;
    t.height_m = 0.006f * raised + 0.0006f * fine;
    return t;
  });
}

}  // namespace petrichor::city
