#include "systems/wetness/film.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace petrichor {
namespace {

constexpr double mm_per_hour = 1e-3 / 3600.0;

// The same law in steps so short that its order does not matter.
Film integrated(Film f, const FilmLaw& law, double dt_s, double step_s) {
  for (double t = 0.0; t < dt_s; t += step_s) {
    const double step = std::min(step_s, dt_s - t);
    double film = f.film_m, pores = f.pores_m;
    const double net = law.supply_mps - law.evaporation_mps;
    if (film <= 0.0 && net <= 0.0) {
      if (law.pores_m > 0.0) pores += step * (law.supply_mps - law.evaporation_mps * pores / law.pores_m);
    } else {
      double taken = pores < law.pores_m ? law.absorption_mps : 0.0;
      if (film <= 0.0) taken = std::min(taken, net);
      taken = std::min(taken, (law.pores_m - pores) / step);
      pores += taken * step;
      film += step * (net - taken - law.drain_per_m2s * film * film * film);
    }
    f = {std::max(film, 0.0), pores};
  }
  return f;
}

FilmLaw street(double rain_mm_per_hour) {
  FilmLaw law;
  law.supply_mps = rain_mm_per_hour * mm_per_hour;
  law.drain_per_m2s = drain_per_m2s(0.02, 5.0);
  law.pores_m = 0.1e-3;
  law.absorption_mps = 50.0 * mm_per_hour;
  return law;
}

TEST(Film, IsAsThickAsTheBooksSay) {
  // Shared physics, section 9: R = 20 mm/h over 5 m of slope 0.02: 0.75 mm; 100 mm/h: 1.3 mm. Those are of the end of
  // the slope, q = R L; ours is in balance with the same q.
  FilmLaw law = street(20.0);
  law.pores_m = 0.0;
  EXPECT_NEAR(advance({}, law, 7200.0).film_m, 0.75e-3, 0.01e-3);
  law.supply_mps = 100.0 * mm_per_hour;
  EXPECT_NEAR(advance({}, law, 7200.0).film_m, 1.28e-3, 0.02e-3);
}

TEST(Film, IsWhatFineStepsGive) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 60; ++i) {
    FilmLaw law;
    law.supply_mps = unit(random) < 0.4 ? 0.0 : 60.0 * unit(random) * unit(random) * mm_per_hour;
    law.evaporation_mps = 20.0 * unit(random) * unit(random) * mm_per_hour;
    law.drain_per_m2s = drain_per_m2s(std::pow(10.0, -2.0 * unit(random)), 3.0);
    law.pores_m = unit(random) < 0.3 ? 0.0 : 0.1e-3 * unit(random);
    law.absorption_mps = 50.0 * mm_per_hour;
    const Film start{unit(random) < 0.3 ? 0.0 : 0.3e-3 * unit(random), law.pores_m * unit(random)};
    const double dt = 5.0 + 100.0 * unit(random);
    const Film got = advance(start, law, dt), want = integrated(start, law, dt, 1e-4);
    EXPECT_NEAR(got.film_m, want.film_m, 2e-4 * want.film_m + 2e-9) << i;
    EXPECT_NEAR(got.pores_m, want.pores_m, 2e-4 * law.pores_m + 2e-9) << i;
  }
}

TEST(Film, NoWaterComesFromNowhere) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    FilmLaw law = street(200.0 * unit(random));
    law.evaporation_mps = mm_per_hour * unit(random);
    const Film start{1e-3 * unit(random), law.pores_m * unit(random)};
    const double dt = std::pow(10.0, 6.0 * unit(random) - 2.0);
    const Film f = advance(start, law, dt);
    ASSERT_TRUE(std::isfinite(f.film_m) && std::isfinite(f.pores_m));
    ASSERT_GE(f.film_m, 0.0);
    ASSERT_GE(f.pores_m, 0.0);
    ASSERT_LE(f.pores_m, law.pores_m * (1.0 + 1e-9));
    ASSERT_LE(f.film_m + f.pores_m, start.film_m + start.pores_m + law.supply_mps * dt * (1.0 + 1e-9) + 1e-15);
  }
}

TEST(Film, PoresFillFirstAndDryLast) {
  FilmLaw law = street(10.0);
  const double fills_s = law.pores_m / law.supply_mps;
  EXPECT_EQ(advance({}, law, 0.9 * fills_s).film_m, 0.0);
  EXPECT_GT(advance({}, law, 1.1 * fills_s).film_m, 0.0);
  law.supply_mps = 0.0;
  law.evaporation_mps = 0.2 * mm_per_hour;
  Film f{0.3e-3, law.pores_m};
  double bare_s = 0.0;
  for (; f.film_m > 0.0; bare_s += 30.0) {
    EXPECT_NEAR(f.pores_m, law.pores_m, 1e-12);
    f = advance(f, law, 30.0);
  }
  EXPECT_GT(bare_s, 600.0);
  EXPECT_GT(f.pores_m, 0.95 * law.pores_m);
  EXPECT_LT(advance(f, law, 4.0 * 3600.0).pores_m, 0.01 * law.pores_m);
}

TEST(Film, RunsOffAWallFasterThanOffAStreet) {
  const double street_m = drained_film_m(0.5e-3, 0.0, drain_per_m2s(0.02, 3.0), 60.0);
  const double wall_m = drained_film_m(0.5e-3, 0.0, drain_per_m2s(1.0, 3.0), 60.0);
  // h = 1 / sqrt(2 c t) once it has forgotten its start: 7 times thinner on a wall.
  EXPECT_GT(street_m / wall_m, 4.0);
  EXPECT_LT(street_m / wall_m, 7.1);
}

TEST(Film, EvaporatesAsTheBooksSay) {
  // Shared physics, section 9: 0.05 to 0.3 mm/h.
  EXPECT_GT(evaporation_mps(12.0, 0.8, 2.0), 0.03 * mm_per_hour);
  EXPECT_LT(evaporation_mps(22.0, 0.6, 4.0), 0.35 * mm_per_hour);
  EXPECT_EQ(evaporation_mps(12.0, 1.0, 2.0), 0.0);
}

}  // namespace
}  // namespace petrichor
