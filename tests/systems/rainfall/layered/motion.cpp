// How the layered composite follows rain, wind and camera from tick to tick.
#include "systems/rainfall/layered/motion.hpp"

#include <gtest/gtest.h>

#include <set>

#include "components/transform.hpp"
#include "components/view.hpp"
#include "systems/geometry/extract.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/layered/textures.hpp"
#include "systems/scene/propagate.hpp"

namespace petrichor {
namespace {

constexpr double tick_s = 1.0 / 120.0;

struct Street {
  Registry registry;
  Entity weather, camera;
  std::int64_t tick = -1;

  Street() {
    weather = registry.create();
    Emitter emitter;
    emitter.rain_mm_per_hour = 10.0f;
    registry.emplace<Emitter>(weather, emitter);
    registry.emplace<Wind>(weather);
    registry.emplace<LayeredComposite>(weather);
    camera = registry.create();
    registry.emplace<Camera>(camera);
    registry.emplace<Transform>(camera);
  }
  void step() {
    ++tick;
    simulate_rainfall(registry, double(tick) * tick_s);
    simulate_layered(registry, double(tick) * tick_s);
    propagate_transforms(registry);
    track_cameras(registry);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) step();
  }
  FrameLayered frame(double interpolation = 1.0) {
    Frame f;
    f.width = 160, f.height = 90;
    const double time_s = (double(tick) - 1.0 + interpolation) * tick_s;
    extract_camera(registry, f, interpolation, tick_s);
    extract_rainfall(registry, f, time_s);
    extract_layered(registry, f, time_s, interpolation);
    return f.rain->layered;
  }
  LayeredComposite& settings() { return registry.get<LayeredComposite>(weather); }
  LayeredMotion& motion() { return registry.get<LayeredMotion>(weather); }
};

glm::dvec3 way_of(const FrameLayered& layered) {
  return glm::dvec3(layered.turn * glm::vec3(0.0f, -1.0f, 0.0f));
}

TEST(LayeredMotion, TravelsAsFarAsRainPassesTheCamera) {
  Street street;
  street.run(241);
  const FrameLayered calm = street.frame();
  EXPECT_NEAR(way_of(calm).y, -1.0, 1e-6);
  EXPECT_GT(calm.speed_mps, 5.17f);  // of drops of 1.4 to 3 mm (Gunn and Kinzer)
  EXPECT_LT(calm.speed_mps, 8.06f);
  EXPECT_NEAR(calm.travelled_m, 2.0 * calm.speed_mps, 1e-3 * calm.speed_mps);
  EXPECT_NEAR(street.frame(0.5).travelled_m, calm.travelled_m - 0.5 * tick_s * calm.speed_mps, 1e-6);
}

TEST(LayeredMotion, ArtistSpeedAndDirection) {
  Street plain, fast, aside;
  fast.settings().speed = 2.0f;
  aside.settings().direction = {3.0f, 0.0f, 0.0f};
  for (Street* s : {&plain, &fast, &aside}) s->run(121);
  const FrameLayered a = plain.frame(), b = fast.frame(), c = aside.frame();
  EXPECT_NEAR(b.speed_mps, 2.0f * a.speed_mps, 1e-4f);
  EXPECT_NEAR(b.travelled_m, 2.0 * a.travelled_m, 1e-6);
  EXPECT_NEAR(way_of(c).x / -way_of(c).y, 3.0 / a.speed_mps, 1e-4);
}

TEST(LayeredMotion, ScriptsDriveLightning) {
  Street street;
  street.run(2);
  EXPECT_EQ(street.frame().lightning, 0.0f);
  street.settings().rain_contrast = 0.5f;
  street.settings().lightning_1 = 1.5f;
  street.settings().lightning_2 = 0.5f;
  EXPECT_FLOAT_EQ(street.frame().lightning, 1.0f);
}

TEST(LayeredMotion, TeleportMovesNothingOn) {
  Street street;
  street.run(60);
  street.registry.get<Transform>(street.camera).position_m.x = 10'000.0f;
  street.run(1);
  const double before = street.motion().travelled_m;
  const glm::dquat turn = street.motion().turn;
  street.run(3);
  EXPECT_NEAR(street.motion().travelled_m - before, 3.0 * tick_s * street.frame().speed_mps, 1e-3);
  EXPECT_NEAR(std::abs(glm::dot(street.motion().turn, turn)), 1.0, 1e-9);
}

TEST(LayeredMotion, WalkingTiltsTheWay) {
  Street street;
  for (int i = 0; i < 30; ++i) {
    street.registry.get<Transform>(street.camera).position_m.x = 1.5f * float(i * tick_s);
    street.step();
  }
  const FrameLayered layered = street.frame();
  const glm::dvec3 way(layered.turn * glm::vec3(0.0f, -1.0f, 0.0f));
  EXPECT_NEAR(way.x / -way.y, -1.5 / std::sqrt(layered.speed_mps * layered.speed_mps - 1.5 * 1.5), 0.02);
}

TEST(LayeredMotion, TurnIsCarriedWithoutSpinning) {
  // Round a circle of directions and back: no more azimuth than the cone's own angle encloses, and no jump at the pole.
  glm::dquat turn(1.0, 0.0, 0.0, 0.0);
  glm::dvec3 last = turn * glm::dvec3(1.0, 0.0, 0.0);
  for (int i = 0; i <= 720; ++i) {
    const double a = i * M_PI / 180.0;
    turn = follow_way(turn, {std::sin(0.5 * a) * 5.0, -std::cos(a) * 5.0, 0.01});  // up and down through the zenith
    const glm::dvec3 side = turn * glm::dvec3(1.0, 0.0, 0.0);
    EXPECT_LT(glm::distance(side, last), 0.15) << i;
    last = side;
  }
  EXPECT_EQ(follow_way(turn, glm::dvec3(0.0)), turn);  // where nothing moves the last way is kept
}

TEST(LayeredTextures, EveryColumnShowsTheExactShareOfItsDrops) {
  const auto texels = make_placement();
  for (int x = 0; x < layered_placement; ++x)
    for (int channel = 0; channel < 4; ++channel) {
      std::set<int> seen;
      for (int y = 0; y < layered_placement; ++y) seen.insert(texels[std::size_t(y) * layered_placement + x][channel]);
      ASSERT_EQ(seen.size(), 256u) << x << " " << channel;
    }
}

TEST(LayeredTextures, TallerCellsKeepEveryOtherDropInItsPlace) {
  const auto texels = make_placement();
  const auto low = pair_placement(texels, 0), high = pair_placement(texels, 1);
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 4; ++x) {
      const std::uint32_t a = low[std::size_t(2 * y) * layered_placement + x][0],
                          b = high[std::size_t(y) * layered_placement + x][0];
      EXPECT_EQ(a & 0xff00ffffu, b & 0xff00ffffu);
      EXPECT_EQ((a >> 16 & 255u) / 2, b >> 16 & 255u);
    }
}

TEST(LayeredTextures, NormalsAreUnitAndPointOutwards) {
  const auto normals = make_drop_normals(32, 8);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const auto& n = normals[std::size_t(y) * 32 + x];
      if (n[2] == 0) continue;
      EXPECT_LE(std::hypot(n[0], n[1]), 128.0);
      EXPECT_GE(n[0] * (x - 15.5) + n[1] * (y - 15.5), -40.0);
    }
}

}  // namespace
}  // namespace petrichor
