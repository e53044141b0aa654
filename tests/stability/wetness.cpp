// Where wet surfaces fail, and that ours do not. (Shared physics, sections 9 and 12 d.)

#include "systems/wetness/wetness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "systems/wetness/history.hpp"
#include "systems/wetness/optics.h"

namespace petrichor {
namespace {

struct Weather {
  Emitter rain;
  Wind wind;
  WetGround ground;
};

// A quarter of an hour of rain that comes in bursts, turns, and stops, from dry.
Weather weather_at(double t) {
  Weather w;
  w.ground.initial_wetness = 0.0f;
  w.ground.humidity = 0.7f;
  w.rain.rain_mm_per_hour = t < 180.0 ? 12.0f : t < 420.0 ? 50.0f : t < 540.0 ? 0.0f : t < 660.0 ? 4.0f : 0.0f;
  w.wind.velocity_mps = {t < 240.0 ? 1.0f : 6.0f, 0.0f, 0.0f};
  return w;
}

WetnessHistory run(double step_s, double until_s) {
  Weather w = weather_at(0.0);
  WetnessHistory h = start_wetness(w.rain, w.wind, w.ground, 0.0);
  const auto ticks = static_cast<long>(std::llround(until_s / step_s));
  for (long i = 1; i <= ticks; ++i) {
    w = weather_at(i * step_s);
    follow_rain(h, w.rain, w.wind, w.ground, i * step_s);
  }
  return h;
}

TEST(Wetness, FilmIsTheSameInStepsOfA120thAndOfAMinute) {
  for (const double until_s : {120.0, 480.0, 600.0, 900.0}) {
    const WetnessHistory fine = run(1.0 / 120.0, until_s), coarse = run(60.0, until_s);
    ASSERT_EQ(fine.remembered, coarse.remembered) << until_s;
    const auto a = films_at(fine, until_s), b = films_at(coarse, until_s);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int c = 0; c < 4; ++c) ASSERT_NEAR(a[i][c], b[i][c], 1e-3f * b[i][c] + 1e-6f) << until_s << " " << i;
  }
}

// An explicit step of a minute, as a game would take after a hitch: the film of a wall overshoots into the negative
// and grows without end. c h^2 dt > 2/3 is enough.
TEST(Wetness, ExplicitStepsOfAMinuteBlowUpAndTheClosedFormDoesNot) {
  FilmLaw law = film_law(0, 2);
  law.supply_mps = 50e-3 / 3600.0;
  double explicit_m = 1e-3;
  Film ours{1e-3, 0.0};
  for (int i = 0; i < 5; ++i) {
    explicit_m += 60.0 * (law.supply_mps - law.drain_per_m2s * explicit_m * explicit_m * explicit_m);
    ours = advance(ours, law, 60.0);
  }
  EXPECT_FALSE(std::abs(explicit_m) < 1.0);
  EXPECT_NEAR(ours.film_m, std::cbrt(law.supply_mps / law.drain_per_m2s), 1e-6);
}

TEST(Wetness, WetAlbedoIsNeverAboveTheDryOne) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int i = 0; i < 20000; ++i) {
    const float a = unit(random), porosity = unit(random), soaked = unit(random), wetted = unit(random);
    const float wet = wetness::wet_albedo(glm::vec3(a), porosity, soaked, wetted).x;
    ASSERT_GE(wet, 0.0f);
    // Together with what the film mirrors: no more than the dry surface and Re (shared physics, section 9 d).
    ASSERT_LE(wet + wetted * wetness::WATER_RE, a + wetness::WATER_RE + 1e-6f);
    ASSERT_LE(wet, a + 1e-6f);
    ASSERT_LE(wet + wetted * wetness::WATER_RE, 1.0f + 1e-6f);
  }
  EXPECT_LE(wetness::wet_base_colour(glm::vec3(1.0f), 0.0f, 0.0f, 1.0f).x, 1.0f + 1e-6f);
}

TEST(Wetness, OlderFactorsAreTooDark) {
  // x0.3 whatever the albedo (shared physics, section 9): 1.7 times too dark at 0.1, 2.6 times at 0.8.
  EXPECT_NEAR(wetness::film_albedo(glm::vec3(0.1f)).x / (0.3f * 0.1f), 1.7f, 0.1f);
  EXPECT_NEAR(wetness::film_albedo(glm::vec3(0.8f)).x / (0.3f * 0.8f), 2.6f, 0.1f);
}

TEST(Wetness, ADownpourOf200MillimetresStaysAFilm) {
  Weather w;
  w.rain.rain_mm_per_hour = 200.0f;
  w.ground.initial_wetness = 0.0f;
  WetnessHistory h = start_wetness(w.rain, w.wind, w.ground, 0.0);
  for (int i = 1; i <= 3600; ++i) follow_rain(h, w.rain, w.wind, w.ground, i);
  for (const glm::vec4& f : films_at(h, 3600.0)) {
    for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(f[c]) && f[c] >= 0.0f);
    ASSERT_LT(f.x, 3.0f);  // mm; (3 nu 3 m 4 R / (g 0.02))^(1/3) = 2.2 mm at the steepest exposure
    ASSERT_LE(f.w, 1.0f + 1e-6f);
  }
}

TEST(Wetness, RainThatStopsAndStartsWetsWhatItLeft) {
  Weather w;
  w.rain.rain_mm_per_hour = 10.0f;
  WetnessHistory h = start_wetness(w.rain, w.wind, w.ground, 0.0);
  const auto open = [&](double t) { return film_at(h, 1, 0, 0, 14, t); };  // exposure 0.9
  const Film wet = open(0.0);
  double t = 0.0;
  const auto advance_to = [&](double end, float rate) {
    w.rain.rain_mm_per_hour = rate;
    for (t += 0.5; t <= end; t += 0.5) follow_rain(h, w.rain, w.wind, w.ground, t);
    t = end;
  };
  advance_to(300.0, 0.0f);
  const Film drained = open(t);
  EXPECT_LT(drained.film_m, 0.6 * wet.film_m);
  EXPECT_NEAR(drained.pores_m, wet.pores_m, 1e-9);  // pores dry last
  advance_to(6.0 * 3600.0, 0.0f);
  EXPECT_LT(open(t).film_m, 0.01 * wet.film_m);
  advance_to(24.0 * 3600.0, 0.0f);
  EXPECT_FALSE(h.ever_wet);  // nothing left: the pass stops
  advance_to(24.0 * 3600.0 + 1200.0, 10.0f);
  EXPECT_TRUE(h.ever_wet);
  EXPECT_NEAR(open(t).film_m, wet.film_m, 0.02 * wet.film_m);
}

TEST(Wetness, WhenTheWindTurnsTheOldEdgeStaysWetAndDries) {
  Weather w;
  w.rain.rain_mm_per_hour = 10.0f;
  w.wind.velocity_mps = {5.0f, 0.0f, 0.0f};
  w.ground.drying_speed = 20.0f;
  WetnessHistory h = start_wetness(w.rain, w.wind, w.ground, 0.0);
  double t = 0.0;
  const auto pass = [&](double seconds) {
    for (const double end = t + seconds; t < end;) follow_rain(h, w.rain, w.wind, w.ground, t += 0.5);
  };
  pass(300.0);
  EXPECT_EQ(h.remembered, 1);
  w.wind.velocity_mps = {-5.0f, 0.0f, 0.0f};
  pass(1.0);
  ASSERT_EQ(h.remembered, remembered_exposures);
  EXPECT_GT(h.remembered_fall_mps.x, 0.0);
  EXPECT_LT(h.fall_mps.x, 0.0);
  // By exposures: before and now. Index 14 is 0.9; of the remembered ones 3 is 0.86.
  const auto film = [&](int before, int now) { return film_at(h, 1, 0, before, now, t).film_m; };
  const double was_wet = film(3, 0);
  EXPECT_GT(was_wet, 0.3e-3);
  EXPECT_LT(film(0, 14), 1e-6);  // newly exposed: its pores come first
  EXPECT_NEAR(film(3, 14), was_wet, 0.1 * was_wet);
  pass(240.0);
  EXPECT_GT(film(0, 14), 0.3e-3);  // the new edge
  EXPECT_LT(film(3, 0), 0.7 * was_wet);
  EXPECT_GT(film(3, 0), 0.0);
  // Sooner or later nothing is left of it, and the table shrinks again.
  pass(4.0 * 3600.0);
  EXPECT_EQ(h.remembered, 1);
}

TEST(Wetness, AWindThatVeersSlowlyKeepsTheEdgeOfTheLongRain) {
  Weather w;
  w.rain.rain_mm_per_hour = 10.0f;
  w.wind.velocity_mps = {5.0f, 0.0f, 0.0f};
  WetnessHistory h = start_wetness(w.rain, w.wind, w.ground, 0.0);
  double t = 0.0;
  for (; t < 120.0; t += 0.5) follow_rain(h, w.rain, w.wind, w.ground, t);
  for (int i = 0; i < 60; ++i, t += 0.5) {  // half a turn in half a minute
    const float angle = 3.14159f * static_cast<float>(i) / 60.0f;
    w.wind.velocity_mps = glm::vec3(5.0f * std::cos(angle), 0.0f, 5.0f * std::sin(angle));
    follow_rain(h, w.rain, w.wind, w.ground, t);
  }
  EXPECT_NEAR(h.remembered_fall_mps.x, 5.0, 0.2);
  EXPECT_LT(h.fall_mps.x, -4.0);
}

}  // namespace
}  // namespace petrichor
