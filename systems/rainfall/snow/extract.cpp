#include "systems/rainfall/snow/extract.hpp"

#include <algorithm>
#include <cmath>

#include "systems/drops/drop_physics.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/snow/flakes.hpp"

namespace petrichor {
WindMotion start_snow_motion(const Wind& wind) {
  std::vector<double> times;
  for (const FlakeClass& c : make_flake_classes(1.0)) times.push_back(wind_response_s(c.fall_speed_mps));
  return start_wind_motion(wind, times);
}

FrameRain flake_field(const FrameSnow& snow, float share) {
  FrameRain field;
  field.rain_mm_per_hour = snow.snow_mm_per_hour;
  field.seed = snow.seed;
  field.asked_distance_m = snow.asked_distance_m;
  field.maximum_drops = snow.maximum_flakes;
  field.fade_start_m = snow.fade_start_m;
  field.drawn_distance_m = snow.drawn_distance_m;
  for (const SnowClass& c : snow.classes)
    field.classes.push_back({c.diameter_mm, c.fall_speed_mps, c.flakes_per_m3 * share, c.base_flakes_per_m3, c.reach,
                             true, c.origin_m, c.velocity_mps});
  return field;
}

FrameSnow make_frame_snow(const Snowfall& snowfall, const WindMotion& motion, const FrameCamera& camera, int width,
                          int height, double time_s) {
  FrameSnow snow;
  snow.snow_mm_per_hour = snowfall.snow_mm_per_hour;
  // Rain and snow of the same seed have nothing to do with each other.
  snow.seed = snowfall.seed ^ 0x5f1a4e00u;
  snow.asked_distance_m = snowfall.drawn_distance_m;
  snow.maximum_flakes = snowfall.maximum_flakes;
  snow.sway = snowfall.sway;
  snow.clock_s = static_cast<float>(time_s - snow_clock_s * std::floor(time_s / snow_clock_s));
  const auto classes = make_flake_classes(snowfall.snow_mm_per_hour);
  double extinction = 0.0, water = 0.0;
  glm::dvec3 momentum(0.0);
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const FlakeClass& c = classes[k];
    const Drift drift = drift_at(motion, k, time_s);
    const glm::dvec3 fall(0.0, -c.fall_speed_mps, 0.0), velocity = drift.velocity_mps + fall;
    snow.classes.push_back({static_cast<float>(c.diameter_mm), static_cast<float>(c.area_mm2),
                            static_cast<float>(c.fall_speed_mps), static_cast<float>(c.flakes_per_m3),
                            static_cast<float>(c.base_flakes_per_m3), 1.0f, drift.displacement_m + fall * time_s,
                            glm::vec3(velocity)});
    extinction += petrichor::extinction_per_m(c);
    water += petrichor::snow_mm_per_hour(c);
    momentum += petrichor::snow_mm_per_hour(c) * velocity;
  }
  snow.extinction_per_m = static_cast<float>(extinction);
  snow.mean_velocity_mps = water > 0.0 ? glm::vec3(momentum / water) : glm::vec3(0.0f, -1.0f, 0.0f);
  // The mean radius of the helices (flake.glsl), of flakes weighted by what they cover.
  constexpr double mean_radius_diameters = 3.586;
  double covered = 0.0;
  for (const FlakeClass& c : classes) covered += c.diameter_mm * petrichor::extinction_per_m(c);
  if (extinction > 0.0)
    snow.cone_jitter_m = static_cast<float>(snowfall.sway * snowfall.cone_jitter * mean_radius_diameters * 1e-3 *
                                            covered / extinction);
  FrameRain field = flake_field(snow);
  fit_distance(field, camera, width, height);
  snow.fade_start_m = field.fade_start_m;
  snow.drawn_distance_m = field.drawn_distance_m;
  snow.expected_flakes = field.expected_drops;
  for (std::size_t k = 0; k < snow.classes.size(); ++k) snow.classes[k].reach = field.classes[k].reach;
  return snow;
}

RainLayers view_flakes(const FrameSnow& snow, const FrameCamera& camera, int width, int height) {
  if (!(snow.drawn_distance_m > 0.0f)) return {};
  const FrameRain field = flake_field(snow, snow.share(SnowRung::field));
  RainLayers view = layers_in(field, camera.position_m, [&](const RainClass& c, RainBox& box) {
    box = view_box(camera, width, height, snow.drawn_distance_m * c.reach);
    // A flake that is seen while the shutter is open may have left the view when it closes.
    const glm::dvec3 swept = glm::dvec3(c.velocity_mps) * double(camera.exposure_s);
    const double strays = most_sway_diameters * snow.sway * c.diameter_mm * 1e-3;
    box.low += glm::min(swept, 0.0) - strays;
    box.high += glm::max(swept, 0.0) + strays;
    return true;
  });
  for (RainLayerGpu& layer : view.layers)
    layer.expected.w = snow.classes[static_cast<std::size_t>(layer.first_cell.w >> 8)].area_mm2 * 1e-6f;
  return view;
}

First<Snowfall> first_snowfall(const Registry& registry) {
  const auto snowing = first_of<Snowfall>(registry, [](const Snowfall& s) { return s.snow_mm_per_hour > 0.0f; });
  return snowing ? snowing : first_of<Snowfall>(registry);
}

void simulate_snowfall(Registry& registry, double time_s) {
  const Entity entity = first_snowfall(registry).entity;
  if (entity == null_entity) return;
  const Wind wind = first_wind(registry);
  if (SnowMotion* motion = registry.find<SnowMotion>(entity))
    follow_wind(motion->wind, wind, time_s);
  else
    registry.emplace<SnowMotion>(entity, SnowMotion{start_snow_motion(wind)});
}

void extract_snowfall(const Registry& registry, Frame& frame, double time_s) {
  frame.snow.reset();
  const auto found = first_snowfall(registry);
  if (!found || !(found->snow_mm_per_hour > 0.0f)) return;
  Snowfall budgeted = *found;
  if (budgeted.maximum_flakes == 0) budgeted.maximum_flakes = frame.affordable_drops;
  // Before the first tick: the steady motion.
  const SnowMotion* motion = registry.find<SnowMotion>(found.entity);
  frame.snow = make_frame_snow(budgeted, motion ? motion->wind : start_snow_motion(first_wind(registry)), frame.camera,
                               frame.width, frame.height, time_s);
  frame.snow->techniques = frame.techniques;
}

}  // namespace petrichor
