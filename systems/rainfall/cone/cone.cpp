#include "systems/rainfall/cone/cone.hpp"

#include <algorithm>
#include <cmath>

namespace petrichor {
namespace {

constexpr double least_elongation = 0.12;  // shorter streaks would be finer than the textures' rows
constexpr float fade_from_mps = 0.6f, fade_to_mps = 0.1f;
constexpr double t_const_s = 1.0 / 30.0;  // of eq. 3

// The nominal rain that the published constants are tuned to: at 60 frames a second it scrolls at its own speed. With y
// texels of motion a frame, S_streak of eq. 2 and 3 must solve S^2 = 2 y S + 2 y^2.
constexpr double nominal_mps = 6.5, nominal_step_s = 1.0 / 60.0;

// Where layer i seems to be. S_f of eq. 2 is the first layer's radius over it.
double seen_radius_m(const std::array<ConeLayer, cone_layers>& layout, int i, double parallax) {
  return layout[i].radius_m + (parallax - 1.0) * (layout[i].radius_m - layout[0].radius_m);
}
double texels_per_metre(const ConeLayer& l) {
  return cone_texture_size / l.tile_m;
}
double published_streak(const ConeLayer& first, double knob) {
  return knob * (1.0 + std::sqrt(3.0)) * nominal_mps * nominal_step_s * texels_per_metre(first);
}

ConeMeans means_of(const ConeKinds& kinds) {
  static const std::array<ConeMeans, 5> known = [] {
    std::array<ConeMeans, 5> all{};
    for (int i = 0; i < 5; ++i) all[i] = cone_means(static_cast<ConeTexture>(i));
    return all;
  }();
  const ConeMeans &a = known[static_cast<std::size_t>(kinds.first)], &b = known[static_cast<std::size_t>(kinds.second)];
  const double s = kinds.second_share;
  return {a.speed_mps + s * (b.speed_mps - a.speed_mps), a.width_m + s * (b.width_m - a.width_m)};
}

bool is_flakes(ConeTexture t) {
  return t == ConeTexture::snow_fine || t == ConeTexture::snow_coarse;
}

// Mended eq. 2: how much longer a streak is than in the texture, by exposure instead of frame time.
double elongation(const DoubleCone& set, const ConeKinds& kinds, double speed_mps, double exposure_s) {
  const ConeMeans means = means_of(kinds);
  const double long_m = set.streak_length * speed_mps * exposure_s + means.width_m;
  return std::max(long_m / (means.speed_mps * cone_texture_exposure_s + means.width_m), least_elongation);
}

// Carries `side` along while the axis turns, so that the textures do not spin about it.
void turn(glm::vec3& axis, glm::vec3& side, const glm::vec3& to) {
  const glm::vec3 across = glm::cross(axis, to);
  const float sine = glm::length(across), cosine = glm::dot(axis, to);
  if (sine > 1e-7f) {
    const glm::vec3 k = across / sine;
    side = side * cosine + glm::cross(k, side) * sine + k * glm::dot(k, side) * (1.0f - cosine);
  }
  axis = to;
  side = glm::normalize(side - axis * glm::dot(axis, side));
}

double wrap(double x) {
  return x - std::floor(x);
}

// Eq. 1 without t_delta: the precipitation past the camera. C_f damps what the camera's own speed does.
glm::vec3 precipitation(const DoubleCone& set, const ConeFlow& flow) {
  return flow.velocity_mps - set.camera_damping * flow.camera_mps;
}

template <class Class>
glm::vec3 mean_velocity(const std::vector<Class>& classes, const glm::vec3& otherwise, auto weight) {
  glm::dvec3 sum(0.0);
  double all = 0.0;
  for (const Class& c : classes) sum += weight(c) * glm::dvec3(c.velocity_mps), all += weight(c);
  return all > 0.0 ? glm::vec3(sum / all) : otherwise;
}
glm::vec3 velocity_of(const FrameRain& rain) {
  return mean_velocity(rain.classes, rain.mean_velocity_mps, [](const RainClass& c) {
    return c.drawn ? double(c.drops_per_m3) * c.diameter_mm * c.diameter_mm : 0.0;
  });
}
glm::vec3 velocity_of(const FrameSnow& snow) {
  return mean_velocity(snow.classes, snow.mean_velocity_mps,
                       [](const SnowClass& c) { return double(c.flakes_per_m3) * c.area_mm2; });
}

FrameCone steady(const DoubleCone& set, const ConeFlow& flow, const FrameCamera& camera, float step_s, double time_s) {
  ConeTrack track;
  advance_cone(track, set, flow, 0.0);
  advance_cone(track, set, flow, time_s);
  return frame_cone(track, set, flow, camera.angular_velocity_radps, step_s, time_s);
}

}  // namespace

double cone_speed_ratio(double psi) {
  const double s = std::sin(psi), c = std::abs(std::cos(psi));
  return (s + cone_slope * c) * (s + cone_slope * c) / s;
}

double cone_surface_speed_ratio(double psi) {
  return 1.0 + cone_slope * std::abs(std::cos(psi) / std::sin(psi));
}

double published_elongation(double s_streak, double s_f, double c_pixel, double vec_precip_m) {
  return s_streak / (s_f * (c_pixel * s_f * vec_precip_m + s_streak));
}

ConeKinds cone_kinds(ConeTexture asked, float mm_per_hour, bool snow) {
  if (asked != ConeTexture::automatic) return {asked, asked, 0.0f};
  const float from = snow ? 1.0f : 3.0f, to = snow ? 1.7f : 5.0f;
  const float share = std::clamp(std::log(std::max(mm_per_hour, 1e-3f) / from) / std::log(to / from), 0.0f, 1.0f);
  const ConeTexture fine = snow ? ConeTexture::snow_fine : ConeTexture::drizzle;
  const ConeTexture coarse = snow ? ConeTexture::snow_coarse : ConeTexture::rain;
  if (share <= 0.0f) return {fine, fine, 0.0f};
  if (share >= 1.0f) return {coarse, coarse, 0.0f};
  return {fine, coarse, share};
}

void advance_cone(ConeTrack& track, const DoubleCone& set, const ConeFlow& flow, double time_s) {
  const glm::vec3 past = precipitation(set, flow);
  track.speed_mps = glm::length(past);
  // Where nothing moves past the camera the axis is undefined: the last one stays.
  if (track.speed_mps > 0.05) turn(track.axis, track.side, past / static_cast<float>(track.speed_mps));
  const ConeKinds kinds = cone_kinds(set.texture, flow.mm_per_hour, flow.snow);
  const double longer = elongation(set, kinds, track.speed_mps, flow.exposure_s);
  const double dt = track.time_s >= 0.0 ? time_s - track.time_s : 0.0;
  const auto& layout = cone_layout(is_flakes(kinds.first));
  for (int i = 0; i < cone_layers; ++i) {
    // Parallax is in the layers' radii: the same metres are fewer radians farther out.
    track.phase_per_s[i] = set.scroll_speed * track.speed_mps / (longer * layout[i].tile_m);
    track.phase[i] = wrap(track.phase[i] + track.phase_per_s[i] * dt);
  }
  track.scrolled_texels += set.scroll_speed * published_streak(layout[0], set.streak_length) * dt / t_const_s;
  track.time_s = time_s;
}

FrameCone frame_cone(const ConeTrack& track, const DoubleCone& set, const ConeFlow& flow, const glm::vec3& camera_radps,
                     float step_s, double time_s) {
  FrameCone cone;
  cone.published = set.published;
  cone.texture = set.texture;
  cone.axis = track.axis;
  cone.side = track.side;
  cone.speed_mps = static_cast<float>(track.speed_mps);
  const ConeKinds kinds = cone_kinds(set.texture, flow.mm_per_hour, flow.snow);
  const auto& layout = cone_layout(is_flakes(kinds.first));
  for (int i = 0; i < cone_layers; ++i)
    cone.farther[i] = static_cast<float>(seen_radius_m(layout, i, set.parallax) / layout[i].radius_m);
  const double before = track.time_s - time_s;
  if (set.published) {
    // As printed. Vec_precip holds t_delta (eq. 1), so E does; the scroll (eq. 3) is a sum in texels that E then
    // multiplies. S_f of a layer: how much smaller it looks than the first.
    const double vec = track.speed_mps * step_s;
    const double s_streak = published_streak(layout[0], set.streak_length);
    const double scrolled = track.scrolled_texels - set.scroll_speed * s_streak * before / t_const_s;
    for (int i = 0; i < cone_layers; ++i) {
      const double s_f = layout[0].radius_m / seen_radius_m(layout, i, set.parallax);
      const double e = published_elongation(s_streak, s_f, texels_per_metre(layout[0]), vec);
      cone.elongation[i] = static_cast<float>(1.0 / (s_f * e));
      cone.phase[i] = static_cast<float>(wrap(s_f * e * s_f * scrolled / cone_texture_size));
    }
    return cone;
  }
  const auto longer = static_cast<float>(elongation(set, kinds, track.speed_mps, flow.exposure_s));
  for (int i = 0; i < cone_layers; ++i) {
    cone.elongation[i] = longer;
    cone.phase[i] = static_cast<float>(wrap(track.phase[i] - track.phase_per_s[i] * before));
  }
  // While the shutter is open the camera turns by w about the axis and the rain passes |U|: streaks lean by w / |U|.
  // (Turning across the axis makes streaks longer or shorter in the direction of the turn; the cone leaves that out.)
  const float speed = std::max(cone.speed_mps, 1.0f);
  cone.shear_rad_per_m = std::clamp(glm::dot(camera_radps, cone.axis) / speed, -2.0f, 2.0f);
  const float still = std::clamp((cone.speed_mps - fade_to_mps) / (fade_from_mps - fade_to_mps), 0.0f, 1.0f);
  cone.apex_fade = 1.0f - still * still * (3.0f - 2.0f * still);
  return cone;
}

void set_cone(FrameRain& rain, const DoubleCone& set, const FrameCamera& camera, float step_s, double time_s) {
  const ConeFlow flow{velocity_of(rain), camera.velocity_mps, camera.exposure_s, rain.rain_mm_per_hour, false};
  rain.cone = steady(set, flow, camera, step_s, time_s);
  update_onsets(rain);
}

void set_cone(FrameSnow& snow, const DoubleCone& set, const FrameCamera& camera, float step_s, double time_s) {
  const ConeFlow flow{velocity_of(snow), camera.velocity_mps, camera.exposure_s, snow.snow_mm_per_hour, true};
  snow.cone = steady(set, flow, camera, step_s, time_s);
  update_onsets(snow);
}

}  // namespace petrichor
