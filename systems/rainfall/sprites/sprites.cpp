#include "systems/rainfall/sprites/sprites.hpp"

#include <algorithm>
#include <cmath>

#include "components/weather.hpp"
#include "engine/core/random.hpp"
#include "systems/rainfall/extract.hpp"

namespace petrichor {
namespace {

// The emitter that rains, as extract_rainfall takes it.
bool find_emitter(const Registry& registry, Entity& entity) {
  bool found = false;
  registry.view<Emitter>().each([&](Entity e, const Emitter&) {
    if (!found || entity_index(e) < entity_index(entity)) entity = e;
    found = true;
  });
  return found;
}

glm::dvec3 wind_part(const RainClass& c) {
  return glm::dvec3(c.velocity_mps) + glm::dvec3(0.0, c.fall_speed_mps, 0.0);
}

}  // namespace

void simulate_sprites(Registry& registry, double time_s) {
  Entity entity{};
  if (!find_emitter(registry, entity)) return;
  const StreakSprites* found = registry.find<StreakSprites>(entity);
  const RainMotion* rain = registry.find<RainMotion>(entity);
  if (!found || !rain) return;
  const StreakSprites settings = *found;
  const std::vector<DropClass> classes = make_drop_classes(*registry.find<Emitter>(entity));
  if (rain->wind.answers.size() != classes.size()) return;
  SpriteMotion now{time_s, {}, {}};
  for (std::size_t k = 0; k < classes.size(); ++k)
    now.drift_m.push_back(drift_at(rain->wind, k, time_s).displacement_m);
  SpriteMotion* motion = registry.find<SpriteMotion>(entity);
  now.offset_m.assign(classes.size(), glm::dvec3(0.0));
  if (motion && motion->offset_m.size() == classes.size()) now.offset_m = motion->offset_m;
  const bool plain = !settings.freeze && settings.wind == 1.0f;
  // Before the first tick nothing has moved: settings that never change have held since time 0.
  const bool goes_on = motion && motion->drift_m.size() == classes.size();
  for (std::size_t k = 0; k < classes.size() && !plain; ++k) {
    const double step_s = time_s - (goes_on ? motion->time_s : 0.0);
    const glm::dvec3 drift = now.drift_m[k] - (goes_on ? motion->drift_m[k] : glm::dvec3(0.0));
    now.offset_m[k] += settings.freeze ? glm::dvec3(0.0, classes[k].fall_speed_mps * step_s, 0.0) - drift
                                       : (double(settings.wind) - 1.0) * drift;
  }
  if (motion)
    *motion = std::move(now);
  else
    registry.emplace<SpriteMotion>(entity, std::move(now));
}

void extract_sprites(const Registry& registry, Frame& frame, double time_s) {
  Entity entity{};
  if (!frame.rain || !find_emitter(registry, entity)) return;
  FrameRain& rain = *frame.rain;
  const StreakSprites* found = registry.find<StreakSprites>(entity);
  rain.sprites = make_frame_sprites(found ? *found : StreakSprites{}, rain);
  const SpriteMotion* motion = registry.find<SpriteMotion>(entity);
  if (!motion || motion->offset_m.size() != rain.classes.size()) return;
  // Between two ticks settings are those of now.
  rain.sprites.offset_m = motion->offset_m;
  const double since_s = time_s - motion->time_s;
  for (std::size_t k = 0; k < rain.classes.size(); ++k) {
    const RainClass& c = rain.classes[k];
    if (rain.sprites.frozen)
      rain.sprites.offset_m[k] -= glm::dvec3(c.velocity_mps) * since_s;
    else
      rain.sprites.offset_m[k] += (double(rain.sprites.wind) - 1.0) * since_s * wind_part(c);
  }
}

FrameSprites make_frame_sprites(const StreakSprites& settings, const FrameRain& rain) {
  FrameSprites s;
  s.published = settings.published;
  s.frozen = settings.freeze;
  s.hidden = settings.hide_rain;
  s.hide_background = settings.hide_background;
  s.simple_shader = settings.simple_shader;
  s.fraction = std::clamp(settings.fraction, 0.0f, 1.0f);
  s.wind = settings.wind;
  s.directional_response = settings.directional_response;
  s.lamp_response = settings.lamp_response;
  double density = 0.0;
  for (const RainClass& c : rain.classes)
    if (c.drawn) density += c.drops_per_m3;
  const double most = sprites_per_drop * std::max(rain.maximum_drops, 0), asked = 2.0 * rain.asked_distance_m;
  double edge = std::max(asked, 0.0);
  if (density * edge * edge * edge > most)
    // A change of the edge is a change of every place, so while the rate changes it does so in steps.
    edge = std::min(edge, std::exp2(std::floor(4.0 * std::log2(std::cbrt(most / density))) / 4.0));
  s.box_m = std::isfinite(edge) ? static_cast<float>(edge) : 0.0f;
  s.count = static_cast<std::int32_t>(std::min(density * edge * edge * edge, 2e9));
  return s;
}

glm::vec3 sprite_wind(const FrameRain& rain, std::size_t k) {
  return k < rain.classes.size() ? rain.sprites.wind * glm::vec3(wind_part(rain.classes[k])) : glm::vec3(0.0f);
}

SpriteClasses sprite_classes(const FrameRain& rain, const glm::dvec3& camera_m, double share) {
  SpriteClasses result;
  const FrameSprites& sprites = rain.sprites;
  const double edge = sprites.box_m, volume = edge * edge * edge;
  double density = 0.0, below = 0.0;
  for (const RainClass& c : rain.classes)
    if (c.drawn) density += c.drops_per_m3;
  if (!(volume > 0.0) || !(density > 0.0)) return result;
  for (std::size_t k = 0; k < rain.classes.size(); ++k) {
    const RainClass& c = rain.classes[k];
    if (!c.drawn) continue;
    below += c.drops_per_m3;
    // The first so many of the class's drops exist: while the rate changes the others stay as they are. What is left of
    // a drop is one by chance, or the rarest sizes would never be there.
    const double chance = random_float(glm::uvec4(rain.seed, static_cast<std::uint32_t>(k), 0x51u, 0u));
    const auto count = static_cast<std::uint32_t>(c.drops_per_m3 * volume * share + chance);
    if (count == 0 && !sprites.published) continue;
    glm::dvec3 origin = c.origin_m - camera_m;
    if (k < sprites.offset_m.size()) origin += sprites.offset_m[k];
    origin = origin / edge + 0.5;
    const glm::dvec3 whole = glm::floor(origin);
    SpriteClassGpu gpu;
    // Rounding to single precision must not make 1 of it.
    gpu.origin_speed = glm::vec4(glm::min(glm::vec3(origin - whole), 1.0f - 0x1p-24f), c.fall_speed_mps);
    gpu.velocity_diameter = glm::vec4(sprite_wind(rain, k), c.diameter_mm * 1e-3f);
    gpu.velocity_diameter.y -= c.fall_speed_mps;
    gpu.numbers = {static_cast<std::int32_t>(static_cast<std::int64_t>(whole.y)),
                   static_cast<std::int32_t>(result.particles), static_cast<std::int32_t>(k),
                   static_cast<std::int32_t>(std::lround(below / density * 16777216.0))};
    result.classes.push_back(gpu);
    result.particles += count;
  }
  return result;
}

}  // namespace petrichor
