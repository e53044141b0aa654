#include "systems/ripple/seeds.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/random.hpp"
#include "systems/drops/layers.hpp"
#include "systems/ripple/waves.hpp"

namespace petrichor {

std::vector<RippleImpact> shared_impacts(const RippleTick& t, std::int64_t tick, double step_s, float tile_m) {
  std::vector<RippleImpact> impacts;
  if (!t.rain) return impacts;
  const auto low = static_cast<std::uint32_t>(tick);
  for (const RippleRain::Class& c : t.rain->classes) {
    const double mean = double(c.drops_per_m3) * c.fall_speed_mps * tile_m * tile_m * step_s;
    const glm::uvec4 key(low, c.field_index, t.rain->seed, 0x52495050u);
    const std::uint32_t count = poisson_count(random_float(key), static_cast<float>(std::min(mean, 60.0)));
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::vec4 u = random_float4(key + glm::uvec4(0, (i + 1) << 8, 0, 1));
      impacts.push_back({glm::dvec2(u.x, u.y) * double(tile_m), c.diameter_mm, c.fall_speed_mps, tick});
    }
  }
  return impacts;
}

namespace {

struct Window {
  glm::dvec2 low, high;  // world x and z
  double water_m;
};

// The tile and as much around it as a seed reaches.
Window window_of(const RippleTick& t, int cells) {
  const double cell = t.near_cell_m;
  const glm::dvec2 low = glm::dvec2(t.near_centre - cells / 2) * cell;
  const double reach = std::max(12.0 * cell, 0.04);
  return {low - reach, low + cells * cell + reach, t.water_m};
}

}  // namespace

namespace {

// All drops of a class in a box of its own frame, by layer, cell and drop: drops_of_cell and drop_of_cell of
// field.glsl.
std::vector<glm::dvec3> drops_in(const RippleRain::Class& c, std::uint32_t seed, const glm::dvec3& low,
                                 const glm::dvec3& high) {
  std::vector<glm::dvec3> drops;
  RainClass field{};
  field.drops_per_m3 = c.drops_per_m3;
  field.base_drops_per_m3 = c.base_drops_per_m3;
  std::uint32_t number = 0;
  for (const RainLayer& layer : layers_of(field)) {
    const double edge = layer.edge_m;
    const float none = std::exp(-layer.expected);
    const std::uint32_t salt = (c.field_index << 8 | number++) ^ (seed * 0x9e3779b9u);
    const glm::dvec3 begin = glm::floor(low / edge), end = glm::floor(high / edge);
    const auto wrapped = [](double v) { return static_cast<std::uint32_t>(static_cast<std::int64_t>(v)); };
    for (double z = begin.z; z <= end.z; ++z)
      for (double y = begin.y; y <= end.y; ++y)
        for (double x = begin.x; x <= end.x; ++x) {
          const glm::uvec4 bits = random_bits4(glm::uvec4(wrapped(x), wrapped(y), wrapped(z), salt));
          const std::uint32_t count = poisson_count(unit_float(bits.x), layer.expected, none, 255u);
          for (std::uint32_t m = 0; m < count; ++m) {
            const glm::uvec4 b = random_bits4(glm::uvec4(bits.y, bits.z, m, bits.w));
            const glm::dvec3 drop =
                (glm::dvec3(x, y, z) + glm::dvec3(unit_float(b.x), unit_float(b.y), unit_float(b.z))) * edge;
            if (glm::all(glm::greaterThanEqual(drop, low)) && glm::all(glm::lessThanEqual(drop, high)))
              drops.push_back(drop);
          }
        }
  }
  return drops;
}

bool holds(const glm::dvec3& low, const glm::dvec3& high, const glm::dvec3& inner_low, const glm::dvec3& inner_high) {
  return glm::all(glm::lessThanEqual(low, inner_low)) && glm::all(glm::greaterThanEqual(high, inner_high));
}

}  // namespace

std::vector<RippleImpact> FieldDrops::impacts(const FrameRipples& frame, std::int64_t first, std::int64_t last,
                                              std::int64_t since, int cells) {
  std::vector<RippleImpact> found;
  for (std::int64_t tick = first; tick <= last; ++tick) {
    const RippleTick *now = frame.at(tick), *before = frame.at(tick - 1), *lies = frame.at(std::max(tick, since));
    if (!now || !before || !lies || !now->rain || !(lies->near_cell_m > 0.0f) ||
        before->origins_m.size() != now->origins_m.size())
      continue;
    const Window w = window_of(*lies, cells);
    if (rain_ != now->rain) {
      rain_ = now->rain;
      ahead_.assign(rain_->classes.size(), {});
    }
    for (std::size_t k = 0; k < rain_->classes.size(); ++k) {
      const RippleRain::Class& c = rain_->classes[k];
      const glm::dvec3 &a = before->origins_m[k], &b = now->origins_m[k];
      const glm::dvec3 low = glm::dvec3(w.low.x, w.water_m, w.low.y) - glm::max(a, b);
      const glm::dvec3 high = glm::dvec3(w.high.x, w.water_m, w.high.y) - glm::min(a, b);
      Ahead& held = ahead_[k];
      if (!holds(held.low, held.high, low, high)) {
        // So many ticks ahead that not all classes run out together.
        const double fall = c.fall_speed_mps * frame.step_s * static_cast<double>(12 + 5 * k % 8);
        held.low = low - glm::dvec3(0.25, 1e-6, 0.25);
        held.high = high + glm::dvec3(0.25, fall + 1e-6, 0.25);
        held.drops = drops_in(c, rain_->seed, held.low, held.high);
      }
      for (const glm::dvec3& drop : held.drops) {
        const double above = drop.y + a.y, below = drop.y + b.y;
        if (!(above > w.water_m && below <= w.water_m)) continue;
        const glm::dvec3 lands = drop + glm::mix(a, b, (above - w.water_m) / (above - below));
        const glm::dvec2 place(lands.x, lands.z);
        if (glm::all(glm::greaterThan(place, w.low)) && glm::all(glm::lessThan(place, w.high)))
          found.push_back({place, c.diameter_mm, c.fall_speed_mps, tick});
      }
    }
  }
  return found;
}

std::vector<RippleImpact> field_impacts(const FrameRipples& frame, std::int64_t first, std::int64_t last,
                                        std::int64_t since, int cells) {
  FieldDrops drops;
  return drops.impacts(frame, first, last, since, cells);
}

RippleSeedGpu seed_of(const RippleImpact& impact, glm::dvec2 place_cells, double cell_m,
                      const RippleSettings& settings) {
  if (settings.published) {
    // Height in proportion to the drop's mass, as wide as a drop of its splat of a few texels (Tatarchuk and Isidoro
    // 2006, section 4); a drop of 2 mm as high as here.
    const double relative = std::pow(impact.diameter_mm / 2.0, 3);
    const double amplitude = seed_amplitude_m(2.0, 6.49, natural_seed_m) * relative;
    return {{place_cells.x, place_cells.y, amplitude, 4.0}, {0.0f, 0.0f, float(RIPPLE_SEED_PUBLISHED), 0.0f}};
  }
  const double deviation = std::max(natural_seed_m, settings.seed_cells * cell_m);
  return {{place_cells.x, place_cells.y, seed_amplitude_m(impact.diameter_mm, impact.speed_mps, deviation),
           deviation * seed_reach / cell_m},
          {0.0f, 0.0f, float(RIPPLE_SEED_RING), 0.0f}};
}

RippleSeedGpu seed_of(const RippleWake& wake, glm::dvec2 place_cells, double cell_m, bool published) {
  const float reach = std::max(wake.radius_m / static_cast<float>(cell_m) * 1.4f, 6.0f);
  if (published)  // its outline with its mass, as printed: the water rises by it for ever
    return {{place_cells.x, place_cells.y, wake.draft_m * glm::length(wake.moved_m) / wake.radius_m, reach},
            {0.0f, 0.0f, float(RIPPLE_SEED_PUBLISHED), 0.0f}};
  // Minus the gradient of a mound draft (1 - q)^5 along the way it went: 10 draft (moved . r) / reach^2 (1 - q)^4.
  const float moved = glm::length(wake.moved_m);
  const glm::vec2 way = wake.moved_m / moved;
  const float amplitude = 10.0f * wake.draft_m * moved / (reach * static_cast<float>(cell_m));
  return {{place_cells.x, place_cells.y, amplitude, reach}, {way.x, way.y, float(RIPPLE_SEED_WAKE), 0.0f}};
}

std::vector<RippleRing> strongest_rings(const FrameRipples& frame, int most, double life_s) {
  std::vector<RippleRing> rings;
  const auto ticks = static_cast<std::int64_t>(life_s / frame.step_s);
  for (std::int64_t tick = std::max(frame.tick - ticks, frame.first_tick()); tick <= frame.tick; ++tick) {
    const RippleTick* t = frame.at(tick);
    if (!t) continue;
    const double age = frame.time_s - static_cast<double>(tick) * frame.step_s;
    if (age < 0.0 || age >= life_s) continue;
    for (const RippleImpact& i : shared_impacts(*t, tick, frame.step_s, frame.settings.tile_m))
      rings.push_back({i.place_m, static_cast<float>(age),
                       static_cast<float>(seed_amplitude_m(i.diameter_mm, i.speed_mps, natural_seed_m))});
  }
  // By what is left of them; a ring that joins or leaves the strongest does it when it is weak.
  const auto left = [&](const RippleRing& r) {
    return r.amplitude_m * std::exp(-frame.settings.decay_per_s * r.age_s);
  };
  if (static_cast<int>(rings.size()) > most) {
    std::nth_element(rings.begin(), rings.begin() + most, rings.end(),
                     [&](const RippleRing& a, const RippleRing& b) { return left(a) > left(b); });
    const float weakest = left(rings[static_cast<std::size_t>(most)]);
    rings.resize(static_cast<std::size_t>(most));
    for (RippleRing& r : rings) r.amplitude_m *= 1.0f - std::pow(weakest / left(r), 4.0f);
    std::sort(rings.begin(), rings.end(), [](const RippleRing& a, const RippleRing& b) {
      return a.age_s != b.age_s ? a.age_s < b.age_s : a.place_m.x < b.place_m.x;
    });
  }
  return rings;
}

}  // namespace petrichor
