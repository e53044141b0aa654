#include <algorithm>
#include <cmath>

#include "components/water.hpp"
#include "systems/drops/drop_sizes.hpp"
#include "systems/first_of.hpp"
#include "systems/wetness/history.hpp"
#include "systems/wetness/wetness.hpp"

namespace petrichor {
namespace {

Wind wind_of(const Registry& registry) {
  const auto wind = first_of<Wind>(registry);
  return wind ? *wind : Wind{};
}

WetGround ground_of(const Registry& registry, Entity emitter) {
  const WetGround* own = registry.find<WetGround>(emitter);
  return own ? *own : WetGround{};
}

// The classes of a rain as they fall in a steady wind.
FrameRain steady_rain(const Emitter& emitter, const Wind& wind) {
  FrameRain rain;
  rain.rain_mm_per_hour = emitter.rain_mm_per_hour;
  for (const DropClass& c : make_drop_classes(emitter))
    rain.classes.push_back({static_cast<float>(c.diameter_mm), static_cast<float>(c.fall_speed_mps),
                            static_cast<float>(c.drops_per_m3), static_cast<float>(c.base_drops_per_m3), 1.0f, c.drawn,
                            glm::dvec3(0.0),
                            wind.velocity_mps - glm::vec3(0.0f, static_cast<float>(c.fall_speed_mps), 0.0f)});
  rain.mean_velocity_mps = glm::vec3(mean_rain_fall(emitter, wind));
  return rain;
}

// Of the water: classes fall at different tilts, and gusts (a sinusoid's deviation is 0.71 of its amplitude) add.
float tilt_spread_of(const FrameRain& rain, const Wind& wind) {
  const float level = glm::length(glm::vec2(wind.velocity_mps.x, wind.velocity_mps.z));
  float water = 0.0f, mean = 0.0f, square = 0.0f;
  for (const RainClass& c : rain.classes) {
    const float share = c.drops_per_m3 * c.diameter_mm * c.diameter_mm * c.diameter_mm * c.fall_speed_mps;
    const float tilt = level / c.fall_speed_mps, gust = 0.71f * wind.gust_mps / c.fall_speed_mps;
    water += share, mean += share * tilt, square += share * (tilt * tilt + gust * gust);
  }
  if (!(water > 0.0f)) return 0.0f;
  mean /= water;
  return std::sqrt(std::max(square / water - mean * mean, 0.0f));
}

}  // namespace

void simulate_wetness(Registry& registry, double time_s, double) {
  const auto emitter = first_of<Emitter>(registry);
  if (!emitter) return;
  const Wind wind = wind_of(registry);
  const WetGround ground = ground_of(registry, emitter.entity);
  if (WetnessHistory* history = registry.find<WetnessHistory>(emitter.entity))
    follow_rain(*history, *emitter, wind, ground, time_s);
  else
    registry.emplace<WetnessHistory>(emitter.entity, start_wetness(*emitter, wind, ground, time_s));
}

std::shared_ptr<const FrameWetness> make_frame_wetness(const WetnessHistory& history, const WetGround& ground,
                                                       double time_s) {
  if (!history.ever_wet) return nullptr;
  auto wet = std::make_shared<FrameWetness>();
  wet->rain_mm_per_hour = history.raining ? history.rain.rain_mm_per_hour : 0.0f;
  wet->published = ground.published;
  wet->films = films_at(history, time_s);
  wet->remembered = history.remembered;
  const int open = static_cast<int>(std::lround((film_exposures - 1) * std::cbrt(1.0f / most_exposure)));
  const Film film = film_at(history, 1, 0, 0, open, time_s);
  wet->film_mm = static_cast<float>(film.film_m * 1e3);
  wet->soaked = static_cast<float>(film.pores_m / film_law(1, 0).pores_m);
  wet->flown_m = history.flown_m;
  wet->rain = steady_rain(history.rain, history.wind);
  wet->wind = history.wind;
  wet->tilt_spread = tilt_spread_of(*wet->rain, history.wind);
  wet->remembered_fall_mps = glm::vec3(history.remembered_fall_mps);
  return wet;
}

void extract_wetness(const Registry& registry, Frame& frame, double time_s) {
  frame.wetness.reset();
  const auto emitter = first_of<Emitter>(registry);
  if (!emitter || frame.techniques.share(Effect::wetness, WetnessRung::none) >= 1.0f) return;
  const WetGround ground = ground_of(registry, emitter.entity);
  if (const WetnessHistory* history = registry.find<WetnessHistory>(emitter.entity))
    frame.wetness = make_frame_wetness(*history, ground, time_s);
  else
    frame.wetness = make_frame_wetness(start_wetness(*emitter, wind_of(registry), ground, time_s), ground, time_s);
}

}  // namespace petrichor
