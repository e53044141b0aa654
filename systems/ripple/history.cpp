#include "systems/ripple/history.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "components/transform.hpp"
#include "components/view.hpp"
#include "systems/drops/drop_physics.hpp"
#include "systems/drops/drop_sizes.hpp"
#include "systems/first_of.hpp"
#include "systems/ripple/ripple.hpp"
#include "systems/ripple/waves.hpp"

namespace petrichor {
namespace {

constexpr std::size_t chunk_ticks = 120;
constexpr float near_cells_m[] = {0.005f, 0.008f};  // cells for an eye low over the water, and for one that stands
constexpr float low_eye_m = 0.9f, high_eye_m = 1.1f;
constexpr int jump_cells = 64;  // in a tick: the tile is set down anew

std::uint64_t new_identity() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

bool same_drops(const Emitter& a, const Emitter& b) {
  return a.drop_sizes == b.drop_sizes && a.gamma_shape == b.gamma_shape && a.seed == b.seed &&
         a.minimum_diameter_mm == b.minimum_diameter_mm && a.maximum_diameter_mm == b.maximum_diameter_mm;
}

bool same_settings(const RippleSettings& a, const RippleSettings& b) {
  return a.published == b.published && a.wave_speed_mps == b.wave_speed_mps && a.decay_per_s == b.decay_per_s &&
         a.tile_m == b.tile_m && a.seed_cells == b.seed_cells;
}

// While a rate changes the classes are made anew for every hundredth of it.
bool near_enough(float rate, float solved) {
  return rate == solved || (rate > 0.0f && solved > 0.0f && std::abs(rate - solved) < 0.01f * solved);
}

WindMotion start_motion(const Emitter& emitter, const Wind& wind) {
  std::vector<double> responses;
  for (const DropClass& c : make_drop_classes(emitter)) responses.push_back(wind_response_s(c.fall_speed_mps));
  return start_wind_motion(wind, responses);
}

void follow_rain(RippleHistory& h, const Emitter& emitter, const Wind& wind, double time_s) {
  if (!same_drops(h.solved, emitter)) {
    h.motion = start_motion(emitter, wind);
    h.solved.rain_mm_per_hour = -1.0f;
  } else {
    follow_wind(h.motion, wind, time_s);
  }
  if (near_enough(emitter.rain_mm_per_hour, h.solved.rain_mm_per_hour)) return;
  h.solved = emitter;
  h.rain = emitter.rain_mm_per_hour > 0.0f ? make_ripple_rain(emitter, h.settings) : nullptr;
}

// The hollow nearest to a place: the level of its water is that of the entity, as good as (it fills by millimetres).
bool nearest_water(const Registry& registry, const glm::dvec3& place, float& level_m) {
  double nearest = std::numeric_limits<double>::max();
  std::uint32_t index = 0;
  registry.view<Puddle>().each([&](Entity e, const Puddle& puddle) {
    const auto* world = registry.find<WorldTransform>(e);
    if (!world) return;
    const glm::dvec3 middle(world->matrix[3]);
    const double away = std::max(
        glm::length(glm::dvec2(middle.x - place.x, middle.z - place.z)) - 0.5 * glm::length(puddle.size_m), 0.0);
    const std::uint32_t here = entity_index(e);
    if (away > nearest || (away == nearest && here > index)) return;
    nearest = away;
    index = here;
    level_m = static_cast<float>(middle.y);
  });
  return nearest < std::numeric_limits<double>::max();
}

// Where the ground stands in the lower third of the picture.
void place_near_tile(const Registry& registry, const RippleTick* before, std::int64_t tick, RippleTick& now) {
  const auto camera = first_of<Camera>(registry, [](const Camera& c) { return c.active; });
  const auto* world = camera ? registry.find<WorldTransform>(camera.entity) : nullptr;
  if (!world) return;
  const glm::dvec3 eye(world->matrix[3]);
  if (!nearest_water(registry, eye, now.water_m)) return;
  const glm::dvec3 ahead = -glm::normalize(glm::dvec3(world->matrix[2]));
  const double height = eye.y - now.water_m;
  const double level = std::hypot(ahead.x, ahead.z);
  const double down = std::atan2(-ahead.y, level) + 0.38 * glm::radians(double(camera->vertical_fov_deg));
  const double away = std::clamp(height / std::tan(std::clamp(down, 0.15, 1.55)), 0.0, 6.0);
  const glm::dvec2 way = level > 1e-6 ? glm::dvec2(ahead.x, ahead.z) / level : glm::dvec2(0.0);
  const bool was_low = before && before->near_cell_m == near_cells_m[0];
  const bool low = height < (was_low ? high_eye_m : low_eye_m);
  now.near_cell_m = near_cells_m[low ? 0 : 1];
  now.near_centre = glm::ivec2(glm::floor((glm::dvec2(eye.x, eye.z) + way * away) / double(now.near_cell_m)));
  const bool stays = before && before->near_cell_m == now.near_cell_m &&
                     std::max(std::abs(before->near_centre.x - now.near_centre.x),
                              std::abs(before->near_centre.y - now.near_centre.y)) <= jump_cells;
  now.near_since = stays ? before->near_since : tick;
}

// What has moved in the water since the last tick.
void add_wakes(const Registry& registry, RippleHistory& h, RippleTick& t) {
  std::vector<WaderPlace> now;
  std::vector<std::pair<std::uint32_t, RippleWake>> wakes;
  registry.view<Wader>().each([&](Entity e, const Wader& wader) {
    const auto* world = registry.find<WorldTransform>(e);
    if (!world) return;
    const glm::dvec3 place(world->matrix[3]);
    now.push_back({entity_index(e), place});
    const auto before = std::find_if(h.waders.begin(), h.waders.end(),
                                     [&](const WaderPlace& w) { return w.entity == entity_index(e); });
    if (before == h.waders.end()) return;
    const glm::vec2 moved(place.x - before->place_m.x, place.z - before->place_m.z);
    // It rests, was set elsewhere by a script, or is not in the water.
    if (glm::length(moved) < 1e-5f || glm::length(moved) > 1.0f || std::abs(place.y - t.water_m) > wader.height_m)
      return;
    wakes.push_back({entity_index(e), {{place.x, place.z}, moved, wader.radius_m, wader.draft_mm * 1e-3f}});
  });
  h.waders = std::move(now);
  // The order of components in storage must not matter.
  std::sort(wakes.begin(), wakes.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [entity, wake] : wakes) t.wakes.push_back(wake);
  if (!wakes.empty()) h.last_wake = h.next_tick;
}

}  // namespace

std::int64_t run_start(std::int64_t tick, std::int64_t since, double step_s) {
  const auto epoch = static_cast<std::int64_t>(std::llround(ripple_epoch_s / step_s));
  const auto memory = static_cast<std::int64_t>(std::llround(ripple_memory_s / step_s));
  return std::max<std::int64_t>(std::max(tick / epoch * epoch, since) - memory, 0);
}

RippleSettings ripple_settings(const Registry& registry) {
  const auto r = first_of<Ripples>(registry);
  if (!r) return {};
  return {r->published, r->strength, r->wave_speed_mps, r->decay_per_s, r->tile_m, r->seed_cells};
}

std::shared_ptr<const RippleRain> make_ripple_rain(const Emitter& emitter, const RippleSettings& settings) {
  auto rain = std::make_shared<RippleRain>();
  rain->seed = emitter.seed;
  const auto classes = make_drop_classes(emitter);
  const double deviation = std::max<double>(natural_seed_m, settings.seed_cells * settings.tile_m / 256.0);
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const DropClass& c = classes[k];
    const double amplitude = seed_amplitude_m(c.diameter_mm, c.fall_speed_mps, deviation);
    rain->slope_variance_per_s +=
        static_cast<float>(0.5 * seed_squared_slope() * c.drops_per_m3 * c.fall_speed_mps * amplitude * amplitude);
    if (!c.drawn || c.diameter_mm < smallest_ring_mm) continue;
    rain->classes.push_back({static_cast<float>(c.diameter_mm), static_cast<float>(c.fall_speed_mps),
                             static_cast<float>(c.drops_per_m3), static_cast<float>(c.base_drops_per_m3),
                             static_cast<std::uint32_t>(k)});
  }
  return rain;
}

void simulate_ripples(Registry& registry, double time_s, double step_s) {
  const auto emitter = first_of<Emitter>(registry);
  if (!emitter || !(step_s > 0.0)) return;
  const auto found_wind = first_of<Wind>(registry);
  const Wind wind = found_wind ? *found_wind : Wind{};
  const Emitter now = *emitter;
  const RippleSettings settings = ripple_settings(registry);
  const std::int64_t tick = std::llround(time_s / step_s);
  RippleHistory* history = registry.find<RippleHistory>(emitter.entity);
  if (!history || history->next_tick != tick || history->step_s != step_s ||
      !same_settings(history->settings, settings)) {
    RippleHistory fresh;
    fresh.identity = new_identity();
    fresh.solved = now;
    fresh.solved.rain_mm_per_hour = -1.0f;
    fresh.settings = settings;
    fresh.step_s = step_s;
    fresh.motion = history && same_drops(history->solved, now) ? history->motion : start_motion(now, wind);
    fresh.newest.first_tick = fresh.next_tick = tick;
    history = &registry.emplace_or_replace<RippleHistory>(emitter.entity, std::move(fresh));
  }
  RippleHistory& h = *history;
  h.settings.strength = settings.strength;
  follow_rain(h, now, wind, time_s);

  const RippleTick* before = !h.newest.ticks.empty() ? &h.newest.ticks.back()
                             : !h.full.empty()       ? &h.full.back()->ticks.back()
                                                     : nullptr;
  RippleTick t;
  t.rain = h.rain;
  if (h.rain)
    for (const RippleRain::Class& c : h.rain->classes)
      t.origins_m.push_back(drift_at(h.motion, c.field_index, time_s).displacement_m +
                            glm::dvec3(0.0, -c.fall_speed_mps * time_s, 0.0));
  place_near_tile(registry, before, tick, t);
  if (t.near_cell_m > 0.0f) add_wakes(registry, h, t);
  // d<s^2>/dt = rain - 2 decay <s^2>.
  const double kept = std::exp(-2.0 * settings.decay_per_s * step_s);
  const double steady = h.rain ? h.rain->slope_variance_per_s / (2.0 * settings.decay_per_s) : 0.0;
  h.slope_variance = static_cast<float>(steady + (h.slope_variance - steady) * kept);
  t.slope_variance = h.slope_variance;

  h.newest.ticks.push_back(std::move(t));
  ++h.next_tick;
  if (h.newest.ticks.size() < chunk_ticks) return;
  h.full.push_back(std::make_shared<const RippleChunk>(std::move(h.newest)));
  h.newest = {};
  h.newest.first_tick = h.next_tick;
  const std::int64_t oldest = run_start(std::max<std::int64_t>(h.next_tick - 3, 0), 0, step_s) - 2;
  while (!h.full.empty() &&
         h.full.front()->first_tick + static_cast<std::int64_t>(h.full.front()->ticks.size()) < oldest)
    h.full.pop_front();
}

}  // namespace petrichor
