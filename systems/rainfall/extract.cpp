#include "systems/rainfall/extract.hpp"

#include <algorithm>
#include <cmath>

#include "systems/first_of.hpp"
#include "systems/drops/drop_physics.hpp"
#include "systems/drops/layers.hpp"

namespace petrichor {
namespace {

// The fade is the last tenth of the drawn distance.
constexpr double fade_share = 0.9;
constexpr double full_field_drops = 4e8;  // more than any rain out to the largest drawn distance that memory holds

double frustum_solid_angle(const FrameCamera& camera, int width, int height) {
  const double a = std::tan(0.5 * camera.vertical_fov_rad), b = a * width / std::max(height, 1);
  return 4.0 * std::asin(a * b / std::sqrt((1.0 + a * a) * (1.0 + b * b)));
}

}  // namespace

// Shrinks the distance until drops and candidate cells fit the budget. Under a budget each class reaches as far as it
// can still be seen: a streak's coverage goes with D^2 / (z V), so large drops are worth drawing farther away than
// small ones; reach in proportion to D is a little kinder to the small.
void fit_distance(FrameRain& rain, const FrameCamera& camera, int width, int height) {
  const double solid_angle = frustum_solid_angle(camera, width, height);
  // Integral of r^2 times a fade that is linear from fade_share to 1, times the solid angle, at distance 1.
  const double volume = solid_angle * (1.0 - std::pow(fade_share, 4)) / (12.0 * (1.0 - fade_share));
  const double asked = std::max(0.0f, rain.asked_distance_m), most = std::max(0, rain.maximum_drops);
  const auto distance_of = [&](const RainClass& c, double metres_per_mm) {
    return std::min(asked, metres_per_mm * c.diameter_mm);
  };
  const auto drops = [&](double metres_per_mm) {
    double sum = 0.0;
    for (const RainClass& c : rain.classes)
      if (c.drawn) sum += c.drops_per_m3 * volume * std::pow(distance_of(c, metres_per_mm), 3);
    return sum;
  };
  constexpr double smallest_mm = 0.05;
  double low = 0.0, high = asked / smallest_mm;  // where every class reaches the asked distance
  if (drops(high) <= most) low = high;
  for (int i = 0; i < 60 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    (drops(middle) <= most ? low : high) = middle;
  }
  double farthest = 0.0;
  for (const RainClass& c : rain.classes)
    if (c.drawn) farthest = std::max(farthest, distance_of(c, low));
  double extinction = 0.0, reaching = 0.0;
  for (RainClass& c : rain.classes) {
    if (!c.drawn || !(farthest > 0.0)) continue;
    c.reach = static_cast<float>(distance_of(c, low) / farthest);
    const double share = double(c.drops_per_m3) * c.diameter_mm * c.diameter_mm;
    extinction += share;
    reaching += share * c.reach;
  }
  rain.mean_reach = extinction > 0.0 ? static_cast<float>(reaching / extinction) : 1.0f;
  // A narrow view askew to the axes has few drops in a large box of cells: those cost too.
  double distance = farthest;
  for (int i = 0; i < 200 && distance > 0.0; ++i) {
    if (candidate_cells(rain, camera, width, height, static_cast<float>(distance)) <= 1.0e6 + most) break;
    distance *= 0.95;
  }
  rain.drawn_distance_m = static_cast<float>(distance);
  rain.fade_start_m = static_cast<float>(fade_share * distance);
  rain.expected_drops = farthest > 0.0 ? static_cast<float>(drops(low) * std::pow(distance / farthest, 3)) : 0.0f;
}

namespace {

std::vector<double> response_times(const std::vector<DropClass>& classes) {
  std::vector<double> times;
  for (const DropClass& c : classes) times.push_back(wind_response_s(c.fall_speed_mps));
  return times;
}

}  // namespace

Wind first_wind(const Registry& registry) {
  const auto wind = first_of<Wind>(registry);
  return wind ? *wind : Wind{};
}

WindMotion start_rain_motion(const Emitter& emitter, const Wind& wind, int drawn) {
  return start_wind_motion(wind, response_times(make_drop_classes(emitter, drawn)));
}

FrameRain make_frame_rain(const Emitter& emitter, const WindMotion& motion, const FrameCamera& camera, int width,
                          int height, double time_s, int drawn) {
  FrameRain rain;
  rain.rain_mm_per_hour = emitter.rain_mm_per_hour;
  rain.seed = emitter.seed;
  rain.asked_distance_m = emitter.drawn_distance_m;
  rain.maximum_drops = emitter.maximum_drops;
  const auto classes = make_drop_classes(emitter, drawn);
  double extinction = 0.0, drawn_extinction = 0.0, water = 0.0;
  glm::dvec3 momentum(0.0);
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const DropClass& c = classes[k];
    const Drift drift = drift_at(motion, k, time_s);
    const glm::dvec3 fall(0.0, -c.fall_speed_mps, 0.0);
    rain.classes.push_back({static_cast<float>(c.diameter_mm), static_cast<float>(c.fall_speed_mps),
                            static_cast<float>(c.drops_per_m3), static_cast<float>(c.base_drops_per_m3), 1.0f, c.drawn,
                            drift.displacement_m + fall * time_s, glm::vec3(drift.velocity_mps + fall)});
    extinction += petrichor::extinction_per_m(c);
    const double water_here = petrichor::rain_mm_per_hour(c);
    water += water_here;
    momentum += water_here * (drift.velocity_mps + fall);
    if (!c.drawn) continue;
    drawn_extinction += petrichor::extinction_per_m(c);
  }
  rain.extinction_per_m = static_cast<float>(extinction);
  rain.drawn_extinction_per_m = static_cast<float>(drawn_extinction);
  rain.mean_velocity_mps = water > 0.0 ? glm::vec3(momentum / water) : glm::vec3(0.0f, -1.0f, 0.0f);
  fit_distance(rain, camera, width, height);
  return rain;
}

void simulate_rainfall(Registry& registry, double time_s) {
  const auto emitter = first_of<Emitter>(registry);
  if (!emitter) return;
  const Wind wind = first_wind(registry);
  RainMotion* motion = registry.find<RainMotion>(emitter.entity);
  const bool other_classes = motion && (motion->minimum_diameter_mm != emitter->minimum_diameter_mm ||
                                        motion->maximum_diameter_mm != emitter->maximum_diameter_mm);
  if (!motion || other_classes) {
    RainMotion fresh{emitter->minimum_diameter_mm, emitter->maximum_diameter_mm, start_rain_motion(*emitter, wind)};
    if (motion)
      *motion = std::move(fresh);
    else
      registry.emplace<RainMotion>(emitter.entity, std::move(fresh));
    return;
  }
  follow_wind(motion->wind, wind, time_s);
}

void extract_rainfall(const Registry& registry, Frame& frame, double time_s) {
  frame.rain.reset();
  const auto emitter = first_of<Emitter>(registry);
  if (!emitter || !(emitter->rain_mm_per_hour > 0.0f)) return;
  const RainMotion* motion = registry.find<RainMotion>(emitter.entity);
  const bool usable = motion && motion->minimum_diameter_mm == emitter->minimum_diameter_mm &&
                      motion->maximum_diameter_mm == emitter->maximum_diameter_mm;
  Emitter budgeted = *emitter;
  // While the capped field gives way to the full one its budget grows by factors.
  const Techniques& t = frame.techniques;
  const double full = t.share(Effect::rainfall, RainRung::full_field);
  const double field =
      full + t.share(Effect::rainfall, RainRung::drop_field) + t.share(Effect::rainfall, RainRung::near_drops);
  const double capped = emitter->maximum_drops > 0 ? emitter->maximum_drops : std::max(frame.affordable_drops, 1);
  budgeted.maximum_drops = static_cast<std::int32_t>(
      capped * std::pow(std::max(full_field_drops / capped, 1.0), field > 0.0 ? full / field : 0.0));
  // Before the first tick: the steady motion.
  frame.rain = make_frame_rain(budgeted, usable ? motion->wind : start_rain_motion(*emitter, first_wind(registry)),
                               frame.camera, frame.width, frame.height, time_s);
  frame.rain->techniques = frame.techniques;
}

}  // namespace petrichor
