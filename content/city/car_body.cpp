#include <algorithm>
#include <array>
#include <cmath>

#include "content/city/atlases.hpp"
#include "content/city/vehicles.hpp"

namespace petrichor::city {
namespace {

constexpr float sill_m = 0.24f;
constexpr float wheel_m = 0.30f;
constexpr float pi = 3.14159265f;

float smooth(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}
float power(float v, float e) {
  return std::copysign(std::pow(std::abs(v), e), v);
}

struct Body {
  CarShape s;

  float half() const { return 0.5f * s.length_m; }
  // Plan: full in the middle, rounded at both ends.
  float width_at(float z) const {
    const float t = std::abs(z) / half();
    return s.half_width_m * std::pow(std::max(0.0f, 1.0f - std::pow(t, 5.0f)), 0.36f) * (1.0f - 0.05f * t * t);
  }
  float belt_at(float z) const {
    const float zf = s.screen_foot * s.length_m;
    const float zr = s.rear_foot * s.length_m;
    const float front = s.nose_m + (s.bonnet_m - s.nose_m) * smooth(half(), zf, z);
    const float back = s.tail_m + (s.boot_m - s.tail_m) * smooth(-half(), zr, z);
    const float top = z > 0.0f ? front : back;
    const float t = std::abs(z) / half();
    return sill_m + (top - sill_m) * std::pow(std::max(0.0f, 1.0f - std::pow(t, 9.0f)), 0.45f);
  }
  // u from the left sill over the bonnet to the right sill, v from tail to nose.
  glm::vec3 shell(float u, float v) const {
    const float z =
        half() * (v < 0.5f ? -1.0f : 1.0f) * (1.0f - std::pow(1.0f - std::abs(2.0f * v - 1.0f), 1.0f)) * 0.999f;
    const float zz = half() * 0.999f * std::sin((v - 0.5f) * pi * 0.98f) / std::sin(0.49f * pi);
    const float along = 0.35f * zz + 0.65f * z;  // stations crowd towards the rounded ends
    const float a = pi * u;
    const float w = width_at(along);
    const float b = belt_at(along);
    return {w * power(std::cos(a), 0.42f), sill_m + (b - sill_m) * std::pow(std::max(0.0f, std::sin(a)), 0.50f), along};
  }
  float roof_at(float z) const {
    const float l = s.length_m;
    const float rise = smooth(s.screen_foot * l + 0.02f, s.roof_front * l - 0.12f, z) *
                       smooth(s.rear_foot * l - 0.02f, s.roof_back * l + 0.12f, z);
    const float crown = 1.0f - 0.03f * power((z - 0.5f * (s.roof_front + s.roof_back) * l) / l, 2.0f);
    return belt_at(z) - 0.05f + (s.height_m * crown - belt_at(z) + 0.05f) * std::pow(rise, 0.8f);
  }
  // The cabin: u over the roof from left to right, v from the foot of the rear window to that of the windscreen.
  glm::vec3 cabin(float u, float v, float out = 0.0f) const {
    const float z = s.length_m * (s.rear_foot + (s.screen_foot - s.rear_foot) * v);
    const float a = pi * u;
    const float base = belt_at(z) - 0.06f;
    const float top = roof_at(z);
    const float h = std::max(0.0f, top - base);
    const float lift = std::pow(std::max(0.0f, std::sin(a)), 0.55f);
    const float lean = 1.0f - 0.20f * lift * h / 0.6f;  // sides lean in
    const float w = (width_at(z) - 0.075f) * lean;
    glm::vec3 p(w * power(std::cos(a), 0.40f), base + h * lift, z);
    if (out > 0.0f) {
      const glm::vec3 centre(0.0f, base, s.length_m * 0.5f * (s.roof_front + s.roof_back));
      p += glm::normalize((p - centre) * glm::vec3(1.0f, 1.0f, 0.35f)) * out;
    }
    return p;
  }
};

void wheel(Builder& b, float x, float z, float side) {
  const Paint rubber = plain(glm::vec3(0.012f), Finish::rubber);
  const Paint chrome = plain(glm::vec3(0.55f), Finish::chrome);
  const auto at = [&](float offset) { return glm::vec3(x + side * offset, wheel_m, z); };
  b.cylinder(rubber, at(-0.17f), at(0.0f), wheel_m, wheel_m, 10);
  b.cylinder(rubber, at(0.0f), at(0.022f), wheel_m, wheel_m - 0.045f, 10);
  b.cylinder(rubber, at(0.022f), at(0.0f), wheel_m - 0.045f, 0.17f, 10);
  b.cylinder(plain(glm::vec3(0.16f), Finish::steel), at(0.004f), at(0.03f), 0.185f, 0.16f, 10, false, true);
  b.cylinder(chrome, at(0.03f), at(0.055f), 0.11f, 0.03f, 8, false, true);
}

void arch(Builder& b, float x, float z, float side) {
  const float r = wheel_m + 0.065f;
  std::vector<glm::vec3> dark{{x, sill_m - 0.01f, z}};
  std::vector<glm::vec3> lip;
  for (int k = 0; k <= 8; ++k) {
    const float a = pi * static_cast<float>(k) / 8.0f;
    const glm::vec3 p(x, std::max(sill_m - 0.01f, wheel_m + r * std::sin(a)), z + r * std::cos(a) * -side);
    dark.push_back(p);
    lip.push_back(p);
  }
  b.fan(plain(glm::vec3(0.004f), Finish::matte), dark);
  b.tube(plain(glm::vec3(0.02f), Finish::paint), lip, 0.016f, 3);
}

}  // namespace

Mesh car_mesh(const std::string& name, const CarShape& shape, glm::vec3 colour, bool lights_on, CarSign sign) {
  Mesh mesh;
  mesh.name = name;
  Builder b(mesh);
  const Body body{shape};
  const Paint paint = plain(colour, Finish::gloss);
  const Paint glass = plain(glm::vec3(0.006f, 0.008f, 0.009f), Finish::gloss);
  const Paint chrome = plain(glm::vec3(0.55f), Finish::chrome);
  const Paint black = plain(glm::vec3(0.01f), Finish::rubber);
  b.surface(paint, 12, 18, [&](float u, float v) { return body.shell(u, v); });
  b.surface(paint, 10, 11, [&](float u, float v) { return body.cabin(u, v); });
  // Windows: patches of the cabin lifted a little.
  const auto pane = [&](float u0, float u1, float v0, float v1, int nu, int nv) {
    b.surface(glass, nu, nv,
              [&](float u, float v) { return body.cabin(u0 + (u1 - u0) * u, v0 + (v1 - v0) * v, 0.012f); });
  };
  const float span = shape.screen_foot - shape.rear_foot;
  const float roof_v0 = (shape.roof_back - shape.rear_foot) / span;
  const float roof_v1 = (shape.roof_front - shape.rear_foot) / span;
  const float pillar = 0.5f * (roof_v0 + roof_v1) + 0.04f;
  for (float side : {0.0f, 1.0f}) {
    const auto edge = [&](float a) { return side == 0.0f ? a : 1.0f - a; };
    const float low = 0.045f, high = 0.17f;
    const float a0 = std::min(edge(low), edge(high)), a1 = std::max(edge(low), edge(high));
    pane(a0, a1, pillar + 0.02f, roof_v1 + 0.05f, 2, 4);
    pane(a0, a1, std::max(0.10f, roof_v0 - 0.06f), pillar - 0.02f, 2, 4);
  }
  pane(0.20f, 0.80f, roof_v1 + 0.10f, 0.975f, 6, 3);
  pane(0.22f, 0.78f, 0.03f, std::max(0.10f, roof_v0 - 0.10f), 6, 3);
  const float axle = 0.31f * shape.length_m;
  for (float x : {-1.0f, 1.0f}) {
    for (float z : {-axle, axle}) {
      arch(b, x * (body.width_at(z) + 0.004f), z, x);
      wheel(b, x * (body.width_at(z) + 0.012f), z, x);
    }
    // Sill strip, door gap, handle, mirror.
    b.box(chrome, {x * (shape.half_width_m + 0.004f) - 0.006f, 0.47f, -axle + 0.42f},
          {x * (shape.half_width_m + 0.004f) + 0.006f, 0.49f, axle - 0.42f});
    const float seam = x * (shape.half_width_m - 0.004f);
    for (float z : {-0.42f, 0.52f})
      b.box(black, {seam - 0.006f, 0.30f, z}, {seam + 0.006f, shape.bonnet_m - 0.2f, z + 0.012f});
    b.box(chrome, {x * (shape.half_width_m + 0.012f) - 0.02f, 0.66f, -0.36f},
          {x * (shape.half_width_m + 0.012f) + 0.02f, 0.685f, -0.22f});
    b.box(paint, {x * 0.82f - 0.055f, shape.bonnet_m + 0.08f, 0.52f},
          {x * 0.82f + 0.055f, shape.bonnet_m + 0.18f, 0.58f});
  }
  // Lamps, bumpers, grille, plates.
  const float front = body.half();
  for (float x : {-0.52f, 0.52f}) {
    const glm::vec3 eye(x, 0.58f, front - 0.115f);
    b.cylinder(chrome, eye - glm::vec3(0, 0, 0.12f), eye + glm::vec3(0, 0, 0.035f), 0.125f, 0.11f, 12);
    const Paint lens = lights_on ? glow(Glow::headlight) : plain(glm::vec3(0.30f), Finish::chrome);
    b.cylinder(lens, eye + glm::vec3(0, 0, 0.02f), eye + glm::vec3(0, 0, 0.045f), 0.108f, 0.06f, 12, false, true);
    const glm::vec3 tail(x * 1.04f, 0.60f, -front + 0.10f);
    const Paint red = lights_on ? glow(Glow::taillight) : plain({0.22f, 0.008f, 0.008f}, Finish::gloss);
    b.cylinder(chrome, tail + glm::vec3(0, 0, 0.06f), tail - glm::vec3(0, 0, 0.012f), 0.085f, 0.08f, 10);
    b.cylinder(red, tail - glm::vec3(0, 0, 0.0f), tail - glm::vec3(0, 0, 0.035f), 0.076f, 0.045f, 10, false, true);
  }
  for (float end : {-1.0f, 1.0f}) {
    std::vector<glm::vec3> bumper;
    for (int k = 0; k <= 6; ++k) {
      const float t = -1.0f + 2.0f * static_cast<float>(k) / 6.0f;
      bumper.emplace_back(0.80f * shape.half_width_m / 0.77f * t, 0.39f,
                          end * (front + 0.07f - 0.22f * std::pow(std::abs(t), 4.0f)));
    }
    b.tube(chrome, bumper, 0.038f, 5);
    const float z = end * (front + 0.112f);
    const float half = 0.24f;
    if (end > 0)
      b.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::number_plate), {-half, 0.33f, z}, {half, 0.33f, z},
                {half, 0.45f, z}, {-half, 0.45f, z});
    else
      b.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::number_plate), {half, 0.33f, z}, {-half, 0.33f, z},
                {-half, 0.45f, z}, {half, 0.45f, z});
  }
  for (int k = 0; k < 4; ++k)
    b.box(chrome, {-0.34f, 0.47f + 0.045f * static_cast<float>(k), front - 0.10f},
          {0.34f, 0.485f + 0.045f * static_cast<float>(k), front + 0.012f});
  b.box(black, {-shape.half_width_m + 0.08f, 0.16f, -front + 0.35f},
        {shape.half_width_m - 0.08f, sill_m + 0.03f, front - 0.35f}, face_all & ~face_top);
  if (sign == CarSign::taxi) {
    const float y = shape.height_m;
    b.box(plain({0.5f, 0.3f, 0.04f}, Finish::gloss), {-0.24f, y - 0.02f, -0.28f}, {0.24f, y + 0.12f, -0.16f},
          face_sides | face_top);
    b.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::taxi), {-0.24f, y, -0.16f}, {0.24f, y, -0.16f},
              {0.24f, y + 0.12f, -0.16f}, {-0.24f, y + 0.12f, -0.16f});
    b.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::taxi), {0.24f, y, -0.28f}, {-0.24f, y, -0.28f},
              {-0.24f, y + 0.12f, -0.28f}, {0.24f, y + 0.12f, -0.28f});
  }
  return mesh;
}

}  // namespace petrichor::city
