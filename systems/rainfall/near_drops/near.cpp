#include "systems/rainfall/near_drops/near.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/techniques.hpp"
#include "components/weather.hpp"
#include "systems/rainfall/drop_optics.hpp"

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double nearest_m = 0.3;  // of what the field draws singly (systems/rainfall/passes.cpp)

struct Lens {
  double wide, tall, pixels_per_radian, corner;  // tangents of half the view; cosine of its corner's angle
};
Lens lens_of(const Frame& frame) {
  const double tall = std::tan(0.5 * frame.camera.vertical_fov_rad);
  const double wide = tall * frame.width / std::max(frame.height, 1);
  return {wide, tall, 0.5 * frame.height / tall, 1.0 / std::sqrt(1.0 + wide * wide + tall * tall)};
}

}  // namespace

NearChoice near_choice(const Frame& frame) {
  NearChoice choice;
  if (!frame.rain || !(frame.rain->drawn_distance_m > 0.0f)) return choice;
  const FrameRain& rain = *frame.rain;
  const FrameNearDrops& set = rain.near_drops;
  const float off = rain.techniques.share(Effect::near_drops, NearDropRung::off);
  const float maps = rain.techniques.share(Effect::near_drops, NearDropRung::maps);
  const float field = rain.field_share();
  if (!(field > 0.0f) || off >= 1.0f) return choice;
  choice.share = rain.share(RainRung::near_drops) / field * (1.0f - off);
  choice.maps_share = maps / (1.0f - off);
  choice.least_width_px = std::max(set.least_width_px, 0.05f);
  // Nearer than z = D f / w an image is wider than w (shared physics, section 2): counts go with w^-3.
  const Lens lens = lens_of(frame);
  double at_one_px = 0.0;
  for (const RainClass& c : rain.classes) {
    const double z = c.diameter_mm * 1e-3 * lens.pixels_per_radian;
    if (c.drawn) at_one_px += c.drops_per_m3 * 4.0 / 3.0 * lens.wide * lens.tall * z * z * z;
  }
  at_one_px *= rain.share(RainRung::near_drops);
  const double most = std::max(set.most_drops, 1);
  choice.least_width_px = std::max(choice.least_width_px, static_cast<float>(std::cbrt(at_one_px / most)));
  choice.expected = at_one_px / std::pow(choice.least_width_px, 3.0);
  if (set.published) {
    // "All generated raindrops are positioned at least 2 meters away"; "10 meters ... as the side of a huge cube".
    choice.least_distance_m = 2.0f;
    choice.half_cube_m = 0.5f * NEAR_CUBE_M;
  }
  return choice;
}

glm::vec4 near_uniform(const NearChoice& c) {
  return {c.share, 0.5f * c.least_width_px, c.least_distance_m, c.half_cube_m};
}

RainLayers near_layers(const Frame& frame, const NearChoice& choice) {
  FrameRain thinned = *frame.rain;
  for (RainClass& c : thinned.classes) c.drops_per_m3 *= frame.rain->field_share();  // as view_layers
  const Lens lens = lens_of(frame);
  const FrameCamera& camera = frame.camera;
  const glm::dquat now(camera.orientation);
  const glm::dvec3 turn = glm::dvec3(camera.angular_velocity_radps) * double(camera.exposure_s);
  const double angle = glm::length(turn);
  const glm::dquat then = angle > 1e-12 ? glm::angleAxis(-angle, turn / angle) * now : now;
  const glm::dvec3 moved = -glm::dvec3(camera.velocity_mps) * double(camera.exposure_s);
  return layers_in(thinned, camera.position_m, [&](const RainClass& c, RainBox& box) {
    if (!c.drawn) return false;
    // A sphere's image grows towards the corners, by the square root of the cosine across.
    const double diameter = c.diameter_mm * 1e-3;
    const double depth =
        diameter * lens.pixels_per_radian / (choice.least_width_px * std::sqrt(lens.corner)) + diameter;
    if (depth < nearest_m) return false;
    box.low = glm::min(glm::dvec3(0.0), moved);
    box.high = glm::max(glm::dvec3(0.0), moved);
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 ray((i & 1 ? lens.wide : -lens.wide), (i & 2 ? lens.tall : -lens.tall), -1.0);
      const glm::dvec3 corner = (i & 4 ? then : now) * ray * depth + (i & 4 ? moved : glm::dvec3(0.0));
      box.low = glm::min(box.low, corner);
      box.high = glm::max(box.high, corner);
    }
    // The middle of its way counts, half an exposure before the shutter closes.
    const glm::dvec3 swept = glm::dvec3(c.velocity_mps) * double(camera.exposure_s);
    box.low += glm::min(swept, 0.0) - diameter;
    box.high += glm::max(swept, 0.0) + diameter;
    return true;
  });
}

std::vector<glm::vec4> make_near_curve() {
  std::vector<glm::vec4> curve;
  for (int i = 0; i <= NEAR_CURVE; ++i) {
    const double in = 0.5 * pi * i / NEAR_CURVE, offset = std::sin(in);
    const auto rays = trace_sphere(offset);
    curve.emplace_back(2.0 * (in - std::asin(offset / water_refractive_index)), rays[0].share, rays[1].share,
                       rays[2].share);
  }
  return curve;
}

glm::dvec3 traced_drop(const World& world, const glm::dvec3& eye, const glm::dvec3& centre, double radius,
                       const glm::dvec3& right, const glm::dvec3& up, const glm::dvec2& offset, int interactions) {
  const glm::dvec3 target = centre + radius * (offset.x * right + offset.y * up);
  glm::dvec3 ray = glm::normalize(target - eye);
  const glm::dvec3 from = eye - centre;
  const double along = glm::dot(from, ray), square = glm::dot(from, from);
  const double inside = along * along - square + radius * radius;
  if (inside < 0.0) return world(eye, ray);
  glm::dvec3 at = centre + from + ray * (-along - std::sqrt(inside));
  glm::dvec3 normal = (at - centre) / radius;
  // Polarisations keep to their plane, which is the same at every surface of a sphere.
  const Fresnel f = fresnel(-glm::dot(ray, normal));
  glm::dvec3 sum = 0.5 * (f.across + f.within) * world(at, glm::reflect(ray, normal));
  double across = 0.5 * (1.0 - f.across), within = 0.5 * (1.0 - f.within);
  ray = glm::refract(ray, normal, 1.0 / water_refractive_index);
  for (int i = 2; i <= interactions; ++i) {
    at += ray * (-2.0 * glm::dot(ray, at - centre));
    normal = (at - centre) / radius;
    // Leaves under the angle that it came in by: the same reflectances.
    glm::dvec3 out = glm::refract(ray, -normal, water_refractive_index);
    if (glm::dot(out, out) < 0.5) out = glm::normalize(ray - normal * glm::dot(ray, normal));  // grazing, by rounding
    sum += (across * (1.0 - f.across) + within * (1.0 - f.within)) * world(at, out);
    across *= f.across;
    within *= f.within;
    ray = glm::reflect(ray, normal);
  }
  return sum;
}

void extract_near_drops(const Registry& registry, Frame& frame) {
  if (!frame.rain) return;
  Entity entity{};
  bool any = false;
  registry.view<const Emitter>().each([&](Entity e, const Emitter&) {
    if (!any || entity_index(e) < entity_index(entity)) entity = e, any = true;
  });
  const NearDrops* set = any ? registry.find<NearDrops>(entity) : nullptr;
  if (!set) return;
  FrameNearDrops& out = frame.rain->near_drops;
  out = {.published = set->published,
         .least_width_px = set->least_width_px,
         .most_drops = set->most_drops,
         .step_m = set->step_m,
         .map_cells = std::clamp(set->map_cells, 2, 64),
         .map_pixels = std::clamp(set->map_pixels, 4, 64)};
}

}  // namespace petrichor
