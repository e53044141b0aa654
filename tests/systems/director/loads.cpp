#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "systems/director/director.hpp"
#include "systems/director/figures.hpp"
#include "tests/systems/director/machine.hpp"

namespace petrichor {
namespace {

constexpr int minute = 15 * 60;  // frames

// scripts/cinematics/walk_with_steps.lua on a machine as the shipped figures have it: others use it too, now and then.
// A walk as the checker does it: rain, not fog alone, is to be drawn for most of the wet time.
TEST(Director, AWalkInStepsOfRainShowsRain) {
  constexpr std::array<double, 12> rates{0, 5, 50, 10, 100, 2, 0, 25, 100, 5, 50, 10};
  for (const double noise : {0.05, 0.15})
    for (const double load : {1.0, 1.25}) {
      SCOPED_TRACE(testing::Message() << "noise " << noise << ", load " << load);
      Rehearsal run;
      auto ladders = all_ladders();
      ASSERT_TRUE(load_ladder_figures(std::filesystem::path(PETRICHOR_SOURCE_DIR) / "content/ladders.csv", ladders));
      run.machine.ladders = ladders;
      run.director = make_director(ladders, Techniques());
      run.machine.rest_ms = 57.6;
      run.machine.noise = noise;
      int wet = 0, drawn = 0;
      for (int i = 0; i < 900; ++i) {
        const double rate = rates[static_cast<std::size_t>(i / 75)];
        run.machine.speed = i % 150 < 40 ? load : 1.0;                    // 2.7 s in 10
        run.machine.rest_ms = 57.6 * (1.0 + 0.12 * std::sin(i / 140.0));  // what is in view changes
        run.input.coverage[index_of(Effect::rainfall)] = 1.0 - std::exp(-rate / 5.0);
        run.step();
        wet += rate > 0.0;
        drawn += rate > 0.0 && run.rung(Effect::rainfall) != static_cast<int>(RainRung::fog);
      }
      EXPECT_GT(drawn, 0.75 * wet);
      EXPECT_LT(run.p95(15), 66.0 * 1.05);
      EXPECT_LE(run.director.history.size(), 20u);
      EXPECT_GE(run.director.costs.trust, 2);
      EXPECT_GE(run.shortest_hold_s(), director_hold_s - 1e-9);
    }
}

// A GPU that does in 1.5 ms what the CPU needs 6 for: its timer tells the truth, and the CPU's share is no effect's.
TEST(Director, ATruthfulGpuBesideASlowCpuIsBelieved) {
  Rehearsal run;
  run.machine.speed = 0.02;
  run.input.budget_ms = 16.0;
  run.input.gpu_times = true;
  for (int i = 0; i < 600; ++i) {
    run.step();
    run.input.frame_ms += 5.0;
  }
  EXPECT_GE(run.director.costs.trust, 2);
  EXPECT_EQ(run.rung(Effect::rainfall), static_cast<int>(RainRung::full_field));
  EXPECT_EQ(run.rung(Effect::resolution), static_cast<int>(ResolutionRung::full));
  const CostTable table =
      cost_table(run.director.costs, run.output.techniques, run.input.coverage, run.director.level_ms);
  EXPECT_NEAR(table.ms[index_of(Effect::resolution)][0][0], 5.0 + 60.0 * 0.02 * 0.42, 0.2) << "half the pixels";
}

// One surprise is not a lie: while a neighbour's work makes frames half as long again, the timer keeps its trust.
TEST(Director, LoadFromElsewhereIsNotBlamedOnTheTimer) {
  Rehearsal run;
  run.machine.noise = 0.3;
  run.machine.speed = 0.5;
  for (int i = 0; i < 6 * minute; ++i) {
    run.machine.speed = (i / 70) % 3 == 0 ? 0.9 : 0.5;
    run.step();
    ASSERT_GE(run.director.costs.trust, 2) << "frame " << i;
  }
}

}  // namespace
}  // namespace petrichor
