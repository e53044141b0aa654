// Where drips could break: each test provokes one failure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "systems/drip/physics.hpp"
#include "systems/drops/drop_physics.hpp"
#include "tests/systems/drip/edge.hpp"

namespace petrichor::test {
namespace {

double closure(const DripLedger& l) {
  return std::abs(l.entered_m3 - l.reservoir_m3 - l.pendant_m3 - l.detached_m3) / l.entered_m3;
}

DripSource long_edge() {
  DripSource s;
  s.length_m = 20.0f;
  s.runoff_s = 20.0f;
  return s;
}

bool same_bytes(const FrameDrips& a, const FrameDrips& b) {
  if (a.drops.size() != b.drops.size() || a.landings.size() != b.landings.size()) return false;
  for (std::size_t i = 0; i < a.drops.size(); ++i) {
    const FrameDrip &p = a.drops[i], &q = b.drops[i];
    if (p.place_m != q.place_m || p.velocity_mps != q.velocity_mps || p.diameter_mm != q.diameter_mm ||
        p.stretch != q.stretch || p.seed != q.seed || p.cluster != q.cluster)
      return false;
  }
  for (std::size_t i = 0; i < a.landings.size(); ++i)
    if (a.landings[i].place_m != b.landings[i].place_m || a.landings[i].time_s != b.landings[i].time_s ||
        a.landings[i].diameter_mm != b.landings[i].diameter_mm)
      return false;
  return true;
}

TEST(Drips, WaterIsNeitherMadeNorLostWhileRatesChange) {
  RainyEdge e(10.0f, long_edge());
  const float rates[] = {10, 0, 200, 3, 0, 50, 50, 0.1f};
  double t = 0.0, came = 0.0, before = 0.0;
  float rate = 10.0f;
  e.tick(0.0);
  before = e.ledger(0.0).entered_m3;
  for (const float next : rates) {
    for (int i = 0; i < 600; ++i) {
      came += rate / 3.6e6 * 0.3f * 20.0 / 120.0;
      t += 1.0 / 120.0;
      rate = next;
      e.rain(rate);
      e.tick(t);
    }
    const DripLedger l = e.ledger(t);
    EXPECT_LT(closure(l), 1e-6) << t;
    EXPECT_NEAR(l.entered_m3 - before, came, 1e-6 * came) << t;
    EXPECT_GE(l.pendant_m3, 0.0);
    EXPECT_GE(l.reservoir_m3, 0.0);
  }
}

// The lattice of drops, counted one by one: what falls is what came, not only in the ledger's sums.
TEST(Drips, TheDropsThatFallCarryTheWaterThatCame) {
  DripSource s = long_edge();
  RainyEdge e(20.0f, s);
  e.run(0.0, 1.0);
  const double seconds = 300.0;
  double counted = 0.0;
  std::int64_t drops = 0;
  const DripSourceMotion& m = e.source();
  const double from = water_at(m, 1.0).drained_m2, to = water_at(m, 1.0 + seconds).drained_m2;
  for (int i = 0; i < m.sites; ++i) {
    const DripSite site = drip_site(m, i);
    const auto first = drops_fallen(m, i, site_water_m3(m, site, from));
    const auto last = drops_fallen(m, i, site_water_m3(m, site, to));
    for (auto k = first; k < last; ++k) {
      counted += drip_threshold_m3(m, i, k) - drip_threshold_m3(m, i, k - 1);
      ++drops;
    }
  }
  const double inflow = 20.0 / 3.6e6 * 0.3f * 20.0 * seconds;
  // What hangs at either end: at most a drop a site.
  EXPECT_NEAR(counted, inflow, m.sites * m.drop_m3);
  EXPECT_NEAR(counted, inflow, 0.02 * inflow);
  EXPECT_NEAR(static_cast<double>(drops), inflow / m.drop_m3, 0.02 * inflow / m.drop_m3);
}

TEST(Drips, DoublingTheRainDoublesTheDrops) {
  double before = 0.0;
  for (const float rate : {5.0f, 10.0f, 20.0f, 40.0f}) {
    RainyEdge e(rate, long_edge());
    e.tick(0.0);
    const double drops = e.ledger(1200.0).drops - e.ledger(0.0).drops;
    if (before > 0.0) {
      EXPECT_NEAR(drops / before, 2.0, 0.02) << rate;
    }
    before = drops;
  }
}

TEST(Drips, AfterTheRainTheyDieAwayExponentiallyAndEnd) {
  DripSource s = long_edge();
  s.length_m = 200.0f;
  RainyEdge e(20.0f, s);
  e.run(0.0, 1.0);
  e.rain(0.0f);
  e.tick(1.0);
  const auto fallen = [&](double from, double to) { return e.ledger(to).drops - e.ledger(from).drops; };
  const double first = fallen(1.0, 11.0);
  ASSERT_GT(first, 500.0);
  for (const int later : {20, 40}) {
    const double expected = first * std::exp(-later / 20.0);
    EXPECT_NEAR(fallen(1.0 + later, 11.0 + later), expected, 4.0 * std::sqrt(expected) + 0.03 * expected) << later;
  }
  // All but what can hang has come down, and nothing more ever does.
  EXPECT_EQ(fallen(600.0, 1e6), 0.0);
  EXPECT_LT(closure(e.ledger(1e6)), 1e-6);
  EXPECT_GT(e.ledger(1e6).pendant_m3, 0.0) << "beads stay";
  e.tick(600.0);
  e.camera.position_m = {100.0, 2.0, 5.0};
  const auto frame = e.frame(600.0);
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->landings.empty());
  for (const FrameDrip& d : frame->drops) EXPECT_EQ(d.velocity_mps, glm::vec3(0.0f));
}

// A dry scene has no drops, and the first ones take their time.
TEST(Drips, NoneWithoutRain) {
  RainyEdge e(0.0f, long_edge());
  e.camera.position_m = {10.0, 3.0, 6.0};
  e.run(0.0, 2.0);
  EXPECT_FALSE(e.frame(2.0));
  e.rain(20.0f);
  e.tick(2.0);
  e.tick(300.0);
  EXPECT_TRUE(e.frame(300.0));
}

TEST(Drips, EightfoldStepsAndTenMinutesAtOnceGiveTheSameMass) {
  const auto at_end = [](const std::vector<double>& steps) {
    RainyEdge e(30.0f, long_edge());
    double t = 0.0;
    std::size_t i = 0;
    e.tick(0.0);
    while (t < 600.0 - 1e-9) {
      t = std::min(t + steps[i++ % steps.size()], 600.0);
      e.tick(t);
    }
    return e.ledger(600.0);
  };
  const DripLedger fine = at_end({1.0 / 120}), jittered = at_end({1.0 / 120, 8.0 / 120, 3.0 / 120, 1.0 / 60}),
                   once = at_end({600.0});
  for (const DripLedger& other : {jittered, once}) {
    EXPECT_NEAR(other.detached_m3, fine.detached_m3, 1e-9 * fine.detached_m3);
    EXPECT_EQ(other.drops, fine.drops);
    EXPECT_NEAR(other.entered_m3, fine.entered_m3, 1e-9 * fine.entered_m3);
  }
}

// A rate that a script sets between ticks holds from its tick on: a hitch of a second is worth one tick of rain more.
TEST(Drips, AHitchWhileTheRainStopsCostsNoWater) {
  RainyEdge fine(30.0f, long_edge()), hitch(30.0f, long_edge());
  fine.run(0.0, 5.0);
  hitch.run(0.0, 5.0);
  fine.rain(0.0f), hitch.rain(0.0f);
  fine.run(5.0, 8.0);
  hitch.tick(5.0);
  hitch.tick(8.0);
  EXPECT_NEAR(hitch.ledger(8.0).detached_m3, fine.ledger(8.0).detached_m3, 1e-12);
}

TEST(Drips, ACloudburstStaysFinite) {
  DripSource s = long_edge();
  s.catchment_depth_m = 8.0f;
  RainyEdge e(200.0f, s);
  e.camera.position_m = {10.0, 2.0, 8.0};
  e.run(0.0, 2.0);
  const auto frame = e.frame(2.0);
  ASSERT_TRUE(frame);
  EXPECT_LE(frame->drops.size(), most_drips);
  for (const FrameDrip& d : frame->drops) {
    ASSERT_TRUE(std::isfinite(d.place_m.x + d.place_m.y + d.place_m.z + d.diameter_mm + d.stretch));
    ASSERT_GE(d.place_m.y, -0.01);
    ASSERT_GT(d.diameter_mm, 0.0f);
  }
  EXPECT_LT(closure(e.ledger(2.0)), 1e-6);
  // 8 m of roof in 200 mm/h, as a physical flow: 11 mL a second and site, which is a thread.
  s.site_spacing_mm = 500.0f;
  RainyEdge threads(200.0f, s);
  threads.camera.position_m = {10.0, 2.0, 8.0};
  threads.run(0.0, 2.0);
  float longest = 0.0f;
  for (const FrameDrip& d : threads.frame(2.0)->drops) longest = std::max(longest, d.stretch);
  EXPECT_GT(longest, 5.0f);
}

// The water that falls below 60 drops a second is drawn drop by drop, above it as stretched ones: none is left out.
TEST(Drips, ThreadsCarryAllTheWater) {
  DripSource s;
  s.length_m = 0.1f;
  s.site_spacing_mm = 100.0f;
  s.catchment_depth_m = 100.0f;
  s.runoff_s = 0.0f;
  RainyEdge e(200.0f, s, 6.0f);
  e.camera.position_m = {0.0, 3.0, 10.0};
  e.camera.vertical_fov_rad = 1.2f;
  e.run(0.0, 2.0);
  double drawn = 0.0;
  for (const FrameDrip& d : e.frame(2.0)->drops)
    if (d.velocity_mps.y < 0.0f) drawn += std::pow(1e-3 * d.diameter_mm, 3) * 0.5235988;
  const double terminal = terminal_speed_mps(diameter_mm_of(e.source().drop_m3));
  const double flow = 200.0 / 3.6e6 * 100.0 * 0.1, in_air = flow * time_to_fall_s(terminal, 6.0);
  EXPECT_NEAR(drawn, in_air, 0.06 * in_air);
}

TEST(Drips, TheyHitAtWhatTheFallGivesAndNotAtTerminalSpeed) {
  for (const double height : {0.5, 1.0, 3.0, 10.0}) {
    DripSource s = long_edge();
    RainyEdge e(20.0f, s, static_cast<float>(height));
    e.camera.position_m = {10.0, 1.0, 6.0};
    e.run(0.0, 1.0);
    const auto frame = e.frame(1.0);
    ASSERT_TRUE(frame && !frame->landings.empty());
    for (const DripLanding& l : frame->landings) {
      const double terminal = terminal_speed_mps(l.diameter_mm), speed = -l.velocity_mps.y;
      const double free = std::sqrt(2.0 * 9.81 * height);
      EXPECT_NEAR(l.place_m.y, 0.0, 1e-4);
      EXPECT_LT(speed, free);
      // V^2 (1 - exp(-2 g h / V^2)) of the energy, independently of how it was stepped.
      EXPECT_NEAR(speed, terminal * std::sqrt(1.0 - std::exp(-2.0 * 9.81 * height / (terminal * terminal))),
                  1e-3 * speed);
      if (height == 0.5) {
        EXPECT_GT(speed, 0.95 * free);
      }
      // Physics, section 1: 5 mm drops reach 95% after 9.8 m.
      if (height == 10.0) {
        EXPECT_NEAR(speed / terminal, 0.95, 0.01);
      }
    }
  }
}

// It takes its edge along; what has let go falls where it was.
TEST(Drips, ATeleportedSourceLeavesItsDropsBehind) {
  RainyEdge e(40.0f, long_edge());
  e.run(0.0, 2.0);
  e.registry.get<WorldTransform>(e.edge).matrix = glm::translate(glm::mat4(1.0f), {0, 4, 20});
  e.run(2.0 + 1.0 / 120.0, 2.3);
  e.camera.position_m = {10.0, 2.0, 30.0};
  const auto frame = e.frame(2.3);
  ASSERT_TRUE(frame);
  int behind = 0, moved = 0;
  for (const FrameDrip& d : frame->drops) {
    const bool at_old = std::abs(d.place_m.z) < 0.01, at_new = std::abs(d.place_m.z - 20.0) < 0.01;
    ASSERT_TRUE(at_old || at_new) << d.place_m.z;
    if (at_old) {
      ++behind;
      EXPECT_LT(d.place_m.y, 4.0 - 0.35) << "0.29 s of fall at least";
    } else {
      ++moved;
      if (d.velocity_mps.y < 0.0f) {
        EXPECT_GT(d.place_m.y, 4.0 - 0.45) << "0.3 s of fall at most";
      }
    }
  }
  EXPECT_GT(behind, 20);
  EXPECT_GT(moved, 100);
  EXPECT_LT(closure(e.ledger(2.3)), 1e-6);
}

TEST(Drips, AnEdgeThatIsChangedWhileItDripsLosesNoWater) {
  RainyEdge e(40.0f, long_edge());
  e.run(0.0, 2.0);
  const double before = e.ledger(2.0).entered_m3;
  DripSource& s = e.registry.get<DripSource>(e.edge);
  s.length_m = 7.0f;
  s.lip_radius_mm = 3.5f;
  e.run(2.0, 2.0);
  EXPECT_NEAR(e.ledger(2.0).entered_m3, before, 1e-9 * before);
  EXPECT_LT(closure(e.ledger(2.0)), 1e-6);
  s.runoff_s = 0.0f;
  e.run(2.0 + 1.0 / 120.0, 4.0);
  EXPECT_LT(closure(e.ledger(4.0)), 1e-6);
}

// Frames are drawn in any order, from any number of ticks before them, some of them never: the same bytes.
TEST(Drips, AnyOrderOfFramesGivesTheSameBytes) {
  Wind gusty;
  gusty.velocity_mps = {2.0f, 0.0f, 1.0f};
  gusty.gust_mps = 1.0f;
  const auto make = [&] {
    auto e = std::make_unique<RainyEdge>(30.0f, long_edge());
    e->registry.emplace<Wind>(e->weather, gusty);
    e->camera.position_m = {10.0, 2.0, 9.0};
    return e;
  };
  auto all = make(), one = make();
  const auto turn = [&](RainyEdge& e, int tick) {
    if (tick == 200) e.rain(60.0f);
    if (tick == 240) e.registry.get<Wind>(e.weather).velocity_mps = {-3.0f, 0.0f, 0.0f};
    e.tick(tick / 120.0);
  };
  std::shared_ptr<const FrameDrips> last;
  for (int i = 0; i <= 360; ++i) {
    turn(*all, i);
    turn(*one, i);
    if (i % 5 == 0) {
      all->camera.position_m.x = 10.0 + 0.1 * (i - 360);
      last = all->frame(i / 120.0);
    }
  }
  const auto alone = one->frame(3.0);
  ASSERT_TRUE(last && alone);
  EXPECT_GT(alone->drops.size(), 300u);
  EXPECT_TRUE(same_bytes(*last, *alone));
  // And back to an earlier time, as frames between two ticks are.
  const auto earlier = one->frame(2.5), again = all->frame(2.5);
  EXPECT_TRUE(same_bytes(*earlier, *again));
}

}  // namespace
}  // namespace petrichor::test
