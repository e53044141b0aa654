#include "systems/rainfall/near_drops/near.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/techniques.hpp"
#include "components/weather.hpp"
#include "systems/drops/drop_optics.hpp"

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double nearest_m = 0.3;  // of what the field draws singly (systems/rainfall/passes.cpp)

struct Lens {
  double wide, tall, pixels_per_radian;  // tangents of half the view
};
Lens lens_of(const Frame& frame) {
  const double tall = std::tan(0.5 * frame.camera.vertical_fov_rad);
  const double wide = tall * frame.width / std::max(frame.height, 1);
  return {wide, tall, 0.5 * frame.height / tall};
}

// Where, in the camera's space, the middles of those ways lie that touch the view while the shutter is open: at a depth
// z up to wide z + aside and tall z + above from the axis, rather more than less. A way of half-length h about m
// touches |x| <= w z only if |m.x| <= w (m.z + |h.z|) + |h.x|; so also does a way whose bounding box touches the
// picture (streak.glsl's project). A turn by 2a about a unit axis e makes half a chord of tan(a) |e x m|.
struct Swept {
  double wide, tall, aside, above;
  double along, along_per_m;  // |h.z| <= along + along_per_m z
  double shrunk;              // a turn's chords have their middles nearer, by the cosine of a
  double moved_m;             // of the camera, half its way
};
Swept swept_view(const FrameCamera& camera, const Lens& lens, const RainClass& c) {
  const double open_s = camera.exposure_s;
  const glm::dquat to_camera = glm::conjugate(glm::dquat(camera.orientation));
  const glm::dvec3 turn = to_camera * glm::dvec3(camera.angular_velocity_radps) * open_s;
  const double angle = glm::length(turn), a = std::min(0.5 * angle, 1.2);
  const glm::dvec3 e = angle > 1e-12 ? std::tan(a) * glm::abs(turn / angle) : glm::dvec3(0.0);
  const glm::dvec3 relative = glm::dvec3(c.velocity_mps) - glm::dvec3(camera.velocity_mps);
  glm::dvec3 h = glm::abs(to_camera * relative) * (0.5 * open_s);
  h += 2.0 * glm::dvec3(e.y * h.z + e.z * h.y, e.x * h.z + e.z * h.x, e.x * h.y + e.y * h.x);
  Swept s{};
  s.wide = lens.wide, s.tall = lens.tall;
  for (int i = 0; i < 4; ++i) {
    s.along_per_m = e.x * s.tall + e.y * s.wide;
    const double wide = lens.wide * (1.0 + s.along_per_m) + e.y + e.z * s.tall;
    const double tall = lens.tall * (1.0 + s.along_per_m) + e.x + e.z * s.wide;
    s.wide = std::min(wide, 20.0), s.tall = std::min(tall, 20.0);
  }
  const double diameter = c.diameter_mm * 1e-3;
  const double aside = h.x + lens.wide * h.z + diameter, above = h.y + lens.tall * h.z + diameter;
  s.along = h.z + e.x * above + e.y * aside;
  s.aside = aside + e.z * above + lens.wide * (s.along - h.z);
  s.above = above + e.z * aside + lens.tall * (s.along - h.z);
  s.shrunk = std::cos(a);
  s.moved_m = glm::length(glm::dvec3(camera.velocity_mps)) * 0.5 * open_s;
  return s;
}

// The depth at which an image there is as wide as one at one_depth on the axis: it grows with distance over depth cubed
// (streak.glsl's project). Places are shares of the way from the axis to the edge.
double depth_at(const Swept& s, double one_depth, double x, double y) {
  double z = one_depth;
  for (int i = 0; i < 6; ++i) {
    const double away = glm::length(glm::dvec3(x * (s.wide * z + s.aside), y * (s.tall * z + s.above), z));
    z = std::cbrt((away / s.shrunk + s.moved_m) * one_depth * one_depth);
  }
  return z;
}

// Of the field, m3, whose drops touch the view with images as wide as that. Nearer than z = D f / w they are wider than
// w (shared physics, section 2), so at rest it goes with w^-3.
double swept_volume(const Swept& s, double one_depth) {
  double nearest = nearest_m - s.along;
  if (nearest > 0.0) nearest /= 1.0 + s.along_per_m;
  nearest = std::max(nearest, -std::min(s.aside / s.wide, s.above / s.tall));
  const auto up_to = [&](double z) {
    return z * (s.aside * s.above + z * (0.5 * (s.wide * s.above + s.tall * s.aside) + z * s.wide * s.tall / 3.0));
  };
  double sum = 0.0;
  for (const double x : {0.2113249, 0.7886751})  // Gauss, two points
    for (const double y : {0.2113249, 0.7886751})
      if (const double z = depth_at(s, one_depth, x, y); z > std::max(nearest, nearest_m))
        sum += up_to(z) - up_to(nearest);
  return sum / (s.shrunk * s.shrunk);  // four quarters, of the mean of four points
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
  const Lens lens = lens_of(frame);
  std::vector<Swept> views;
  for (const RainClass& c : rain.classes) views.push_back(swept_view(frame.camera, lens, c));
  const auto expected = [&](double width_px) {
    double sum = 0.0;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const RainClass& c = rain.classes[i];
      if (c.drawn)
        sum += c.drops_per_m3 * swept_volume(views[i], c.diameter_mm * 1e-3 * lens.pixels_per_radian / width_px);
    }
    return sum * rain.share(RainRung::near_drops);
  };
  choice.expected = expected(choice.least_width_px);
  // Falls with the width's cube, slower for long ways.
  const double most = std::max(set.most_drops, 1);
  for (int i = 0; i < 32 && choice.expected > 1.001 * most; ++i) {
    choice.least_width_px *= static_cast<float>(std::cbrt(std::max(choice.expected / most, 1.001)));
    choice.expected = expected(choice.least_width_px);
  }
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
    const double diameter = c.diameter_mm * 1e-3;
    const Swept swept_by = swept_view(camera, lens, c);
    const double axial = depth_at(swept_by, diameter * lens.pixels_per_radian / choice.least_width_px, 1.0, 1.0);
    if (axial < nearest_m) return false;
    // Its way may touch the view deeper than its middle is.
    const double depth = (axial * (1.0 + swept_by.along_per_m) + swept_by.along + diameter) / swept_by.shrunk;
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
