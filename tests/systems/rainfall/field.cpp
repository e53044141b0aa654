// The drop field as mathematics: Poisson, the right number, still while the rate changes, precise far out.
#include "field.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

#include "systems/drops/drop_sizes.hpp"
#include "systems/rainfall/extract.hpp"

namespace petrichor {
namespace {

Emitter rain_of(float mm_per_hour) {
  Emitter e;
  e.rain_mm_per_hour = mm_per_hour;
  return e;
}

FrameRain rain_at(const Emitter& emitter, double time_s, const Wind& wind = {}) {
  return make_frame_rain(emitter, start_rain_motion(emitter, wind), FrameCamera{}, 160, 90, time_s);
}

TEST(DropField, HoldsTheDensityOfEachClass) {
  const FrameRain rain = rain_at(rain_of(20.0f), 3.0);
  const RainBox box{glm::dvec3(-5.0), glm::dvec3(5.0)};
  std::map<std::size_t, double> found;
  for (const FieldDrop& d : drops_in(rain, glm::dvec3(0.0), box)) found[d.cls] += 1.0;
  for (std::size_t k = 0; k < rain.classes.size(); ++k) {
    const double expected = 1000.0 * rain.classes[k].drops_per_m3;
    EXPECT_NEAR(found[k], expected, 5.0 * std::sqrt(expected) + 1.0) << k;
  }
}

TEST(DropField, IsPoisson) {
  // Variance over mean of the counts of boxes that have nothing to do with the cells. For 1000 boxes its own
  // deviation is sqrt(2/999) = 0.045.
  const FrameRain rain = rain_at(rain_of(30.0f), 7.3);
  const RainBox box{glm::dvec3(-6.5), glm::dvec3(6.5)};
  for (const double size : {0.47, 1.3}) {
    const int n = static_cast<int>(13.0 / size);
    std::vector<double> counts(std::size_t(n) * n * n, 0.0);
    for (const FieldDrop& d : drops_in(rain, glm::dvec3(0.0), box)) {
      const glm::ivec3 i((d.position_m - box.low) / size);
      if (i.x < n && i.y < n && i.z < n) counts[(std::size_t(i.z) * n + i.y) * n + i.x] += 1.0;
    }
    double sum = 0.0, squares = 0.0;
    for (double c : counts) sum += c, squares += c * c;
    const double count = static_cast<double>(counts.size()), mean = sum / count;
    const double dispersion = (squares / count - mean * mean) / mean;
    EXPECT_NEAR(dispersion, 1.0, 5.0 * std::sqrt(2.0 / count)) << size;
  }
}

TEST(DropField, RateRampMovesNoDrop) {
  // Drops of a lower rate are all there at a higher one, at the very same place.
  const RainBox box{glm::dvec3(-3.0), glm::dvec3(3.0)};
  std::map<std::tuple<std::size_t, std::uint32_t, int, int, int, std::uint32_t>, glm::dvec3> before;
  for (const float rate : {0.5f, 1.0f, 1.7f, 3.0f, 7.0f, 20.0f, 21.0f, 60.0f, 100.0f, 200.0f}) {
    std::map<std::tuple<std::size_t, std::uint32_t, int, int, int, std::uint32_t>, glm::dvec3> now;
    for (const FieldDrop& d : drops_in(rain_at(rain_of(rate), 5.0), glm::dvec3(0.0), box))
      now[{d.cls, d.layer, d.cell.x, d.cell.y, d.cell.z, d.number}] = d.position_m;
    std::size_t lost = 0;
    for (const auto& [key, position] : before) {
      const auto found = now.find(key);
      if (found == now.end())
        ++lost;
      else
        EXPECT_EQ(found->second, position);
    }
    EXPECT_EQ(lost, 0u) << rate;
    EXPECT_GT(now.size(), before.size());
    before = std::move(now);
  }
}

TEST(DropField, CostFollowsTheRate) {
  // No drop is enumerated that is not there: the cells' expected drops are the density.
  for (const float rate : {0.5f, 5.0f, 50.0f, 200.0f}) {
    for (const RainClass& c : rain_at(rain_of(rate), 0.0).classes) {
      double density = 0.0;
      for (const RainLayer& layer : layers_of(c)) {
        density += layer.expected / (layer.edge_m * layer.edge_m * layer.edge_m);
        EXPECT_LE(layer.expected, drops_per_full_cell * 1.001f);
        EXPECT_LT(layer.edge_m, 16.0f);  // of the rarest drops; more would list cells that hardly touch the view
      }
      EXPECT_NEAR(density, c.drops_per_m3, 1e-3 * c.drops_per_m3);
    }
  }
}

TEST(DropField, FallsAsItShould) {
  // Between two moments every drop moves by its class's speed and the wind, exactly, and none is replaced.
  Wind wind;
  wind.velocity_mps = {2.0f, 0.0f, 1.0f};
  const Emitter emitter = rain_of(10.0f);
  const FrameRain a = rain_at(emitter, 100.0, wind), b = rain_at(emitter, 100.1, wind);
  for (std::size_t k = 0; k < a.classes.size(); ++k) {
    const glm::dvec3 moved = b.classes[k].origin_m - a.classes[k].origin_m;
    EXPECT_NEAR(moved.y, -0.1 * a.classes[k].fall_speed_mps, 1e-5);
    EXPECT_NEAR(moved.x, 0.2, 1e-6);
    EXPECT_NEAR(moved.z, 0.1, 1e-6);
  }
}

TEST(DropField, DoesNotJitterFarOut) {
  // 100 km from the origin and after a day of rain, cells stand where double precision puts them to a hundredth of a
  // millimetre, whatever the camera does.
  Wind wind;
  wind.velocity_mps = {3.0f, 0.0f, 0.0f};
  const Emitter emitter = rain_of(10.0f);
  const FrameRain rain = rain_at(emitter, 86400.0, wind);
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 camera(1e5 + 0.0137 * i, 12.0, -1e5 - 0.0291 * i);
    const RainBox box{glm::dvec3(-5.0), glm::dvec3(5.0)};
    const RainLayers layers = layers_in(rain, camera, [&](const RainClass&, RainBox& b) {
      b = box;
      return true;
    });
    for (const RainLayerGpu& layer : layers.layers) {
      const RainClass& c = rain.classes[std::size_t(layer.first_cell.w >> 8)];
      const glm::dvec3 exact =
          c.origin_m + glm::dvec3(glm::ivec3(layer.first_cell)) * double(layer.corner_edge.w) - camera;
      EXPECT_LT(glm::length(exact - glm::dvec3(layer.corner_edge)), 1e-5);
    }
  }
}

TEST(DropField, DistanceShrinksToTheBudget) {
  FrameCamera camera;
  camera.vertical_fov_rad = 1.047f;
  Emitter emitter = rain_of(50.0f);
  const WindMotion motion = start_rain_motion(emitter, {});
  emitter.maximum_drops = 200000;
  const FrameRain capped = make_frame_rain(emitter, motion, camera, 1280, 720, 0.0);
  float small = 0.0f, large = 0.0f;  // how far they are drawn
  for (const RainClass& c : capped.classes) {
    if (!c.drawn) continue;
    (c.diameter_mm < 1.0f ? small : large) =
        std::max(c.diameter_mm < 1.0f ? small : large, c.reach * capped.drawn_distance_m);
  }
  EXPECT_LT(small, 10.0f);
  EXPECT_GT(large, small) << "what can be seen farther is drawn farther";
  EXPECT_LE(large, emitter.drawn_distance_m);
  EXPECT_NEAR(capped.expected_drops, 200000.0f, 1.0f);
  emitter.maximum_drops = 400000000;
  EXPECT_EQ(make_frame_rain(emitter, motion, camera, 1280, 720, 0.0).drawn_distance_m, emitter.drawn_distance_m);
  emitter.maximum_drops = 0;
  EXPECT_EQ(make_frame_rain(emitter, motion, camera, 1280, 720, 0.0).drawn_distance_m, 0.0f);
  emitter.maximum_drops = 400000000;
  emitter.drawn_distance_m = 500.0f;
  camera.vertical_fov_rad = 0.02f;  // a telescope askew: a huge box of cells for few drops
  camera.orientation = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 1, 0)));
  const FrameRain far = make_frame_rain(emitter, motion, camera, 1280, 720, 0.0);
  EXPECT_LE(candidate_cells(far, camera, 1280, 720, far.drawn_distance_m), 4.02e8);
}

TEST(DropField, NothingFallsAtRateZero) {
  Registry registry;
  Frame frame;
  extract_rainfall(registry, frame, 0.0);
  EXPECT_FALSE(frame.rain);
  const Entity e = registry.create();
  registry.emplace<Emitter>(e);
  simulate_rainfall(registry, 0.0);
  extract_rainfall(registry, frame, 0.0);
  EXPECT_FALSE(frame.rain);
  registry.find<Emitter>(e)->rain_mm_per_hour = 5.0f;
  extract_rainfall(registry, frame, 0.0);
  EXPECT_TRUE(frame.rain);
}

TEST(DropField, StandsAloneWhileTheWindStays) {
  // Frame 900 without frame 899: ticks that change nothing leave no trace.
  Registry ticked, alone;
  for (Registry* r : {&ticked, &alone}) {
    const Entity e = r->create();
    r->emplace<Emitter>(e, rain_of(10.0f));
    Wind wind;
    wind.velocity_mps = {2.0f, 0.0f, 0.0f};
    wind.gust_mps = 1.5f;
    r->emplace<Wind>(e, wind);
  }
  for (int i = 0; i <= 900; ++i) simulate_rainfall(ticked, i / 60.0);
  Frame a, b;
  a.width = b.width = 160;
  a.height = b.height = 90;
  extract_rainfall(ticked, a, 15.0);
  extract_rainfall(alone, b, 15.0);
  ASSERT_TRUE(a.rain && b.rain);
  for (std::size_t k = 0; k < a.rain->classes.size(); ++k)
    EXPECT_EQ(a.rain->classes[k].origin_m, b.rain->classes[k].origin_m);
}

}  // namespace
}  // namespace petrichor
