#include "systems/ripple/measure.hpp"

#include <cmath>

#include "systems/ripple/seeds.hpp"
#include "systems/ripple/truth.hpp"
#include "systems/ripple_frame.hpp"

namespace petrichor {
namespace {

// The rings of a list of drops, each begun at its tick; corner: of the square, world.
std::vector<TrueSlopes> solve(const std::vector<RippleImpact>& drops, const FrameRipples& frame, int cells,
                              double cell_m, glm::dvec2 corner_m, std::int64_t first,
                              const std::vector<std::int64_t>& ticks) {
  SpectralWater water(cells, cells * cell_m, real_water(), frame.settings.decay_per_s);
  const auto shape = water.shape([](double k) { return seed_transform(k, seed_reach * natural_seed_m); });
  std::vector<std::vector<glm::dvec3>> seeds(static_cast<std::size_t>(ticks.back() - first + 1));
  for (const RippleImpact& i : drops)
    seeds[static_cast<std::size_t>(i.tick - first)].emplace_back(
        i.place_m - corner_m - 0.5 * cell_m, seed_amplitude_m(i.diameter_mm, i.speed_mps, natural_seed_m));
  std::vector<TrueSlopes> found;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    water.advance(frame.step_s);
    water.add(seeds[i], shape);
    if (ticks[found.size()] == first + static_cast<std::int64_t>(i)) found.push_back(water.slopes());
  }
  return found;
}

}  // namespace

std::vector<TrueSlopes> true_shared_slopes(const FrameRipples& frame, int cells,
                                           const std::vector<std::int64_t>& ticks) {
  std::vector<RippleImpact> drops;
  for (std::int64_t tick = frame.first_tick(); tick <= ticks.back(); ++tick)
    for (const RippleImpact& i : shared_impacts(*frame.at(tick), tick, frame.step_s, frame.settings.tile_m))
      drops.push_back(i);
  return solve(drops, frame, cells, frame.settings.tile_m / cells, glm::dvec2(0.0), frame.first_tick(), ticks);
}

TrueSlopes true_near_slopes(const FrameRipples& frame, int cells, double seconds) {
  const std::int64_t first =
      std::max(frame.tick - static_cast<std::int64_t>(seconds / frame.step_s), frame.first_tick() + 1);
  const RippleTick& t = *frame.at(frame.tick);
  // Larger than the tile, so that what goes round does not come back.
  const int wide = cells * 3 / 2, margin = cells / 4;
  const auto drops = field_impacts(frame, first, frame.tick, t.near_since, wide);
  const glm::dvec2 corner = glm::dvec2(t.near_centre - wide / 2) * double(t.near_cell_m);
  const TrueSlopes all = solve(drops, frame, wide, t.near_cell_m, corner, first, {frame.tick}).front();
  TrueSlopes middle;
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) middle.push_back(all[static_cast<std::size_t>(y + margin) * wide + x + margin]);
  return middle;
}

namespace {

RippleError compare(const std::vector<glm::vec4>& got, const TrueSlopes& truth, int cells, int margin, int period) {
  double difference = 0.0, of_truth = 0.0, of_got = 0.0, apart = 0.0, both = 0.0;
  for (int y = margin; y < cells - margin; ++y)
    for (int x = margin; x < cells - margin; ++x) {
      const auto at = static_cast<std::size_t>(y) * cells + x;
      const glm::dvec2 g(got[at].x, got[at].y);
      difference += glm::dot(g - truth[at], g - truth[at]);
      of_truth += glm::dot(truth[at], truth[at]);
      of_got += glm::dot(g, g);
      if (period > 0 && x + period < cells - margin) {
        const glm::dvec2 h(got[at + period].x, got[at + period].y);
        apart += glm::dot(g, h);
        both += 0.5 * (glm::dot(g, g) + glm::dot(h, h));
      }
    }
  return {std::sqrt(difference / of_truth), both > 0.0 ? std::abs(apart / both) : 0.0, std::sqrt(of_got / of_truth)};
}

}  // namespace

RippleError shared_error(const std::vector<glm::vec4>& layer, const TrueSlopes& truth, int cells) {
  RippleError e = compare(layer, truth, cells, 0, 0);
  e.repeats = 1.0;
  return e;
}

RippleError near_error(const RippleStage& stage, const Frame& frame, const TrueSlopes& truth) {
  const float cell = frame.ripples->at(frame.ripples->tick)->near_cell_m;
  const int cells = stage.cells(), period = static_cast<int>(std::lround(frame.ripples->settings.tile_m / cell));
  return compare(stage.layer(1), truth, cells, cells / 8, period);
}

}  // namespace petrichor
