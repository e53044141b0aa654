#include "systems/director/figures.hpp"

#include <gtest/gtest.h>

#include "engine/core/paths.hpp"
#include "systems/systems.hpp"

namespace petrichor {
namespace {

TEST(LadderFigures, TakeThePlaceOfWhatTheLadderBrings) {
  auto ladders = all_ladders();
  const auto read = read_ladder_figures(
      "# a remark\neffect,rung,ms,error,stable\nrainfall,double_cone,3.5,0.61,1\n"
      "rainfall, sprites, 12, 0.4, 0\n",
      "x.csv", ladders);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(ladders[0].rungs[1].chart_ms, 3.5);
  EXPECT_EQ(ladders[0].rungs[1].chart_error, 0.61);
  EXPECT_TRUE(ladders[0].rungs[1].stable);
  EXPECT_FALSE(ladders[0].rungs[3].stable);
}

TEST(LadderFigures, AWrongTableSaysWhereAndChangesNothing) {
  const std::string heading = "effect,rung,ms,error,stable\n";
  for (const std::string& text :
       {std::string("rainfall,fog,1,1,1\n"), heading + "rainfall,fog,1,1\n", heading + "rainfall,mist,1,1,1\n",
        heading + "rainfall,fog,fast,1,1\n", heading + "rainfall,fog,1,-1,1\n", heading + "rainfall,fog,nan,1,1\n",
        heading + "rainfall,double_cone,9,9,1\nrainfall,fog,1,1,yes\n"}) {
    auto ladders = all_ladders();
    const double before = ladders[0].rungs[1].chart_ms;
    const auto read = read_ladder_figures(text, "x.csv", ladders);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().message.rfind("x.csv:", 0), 0u) << read.error().message;
    EXPECT_EQ(ladders[0].rungs[1].chart_ms, before);
  }
}

TEST(LadderFigures, TheOnesWeShipAreWhole) {
  auto ladders = all_ladders();
  const auto read = load_ladder_figures(std::filesystem::path(PETRICHOR_SOURCE_DIR) / "content/ladders.csv", ladders);
  ASSERT_TRUE(read) << read.error().message;
  for (const Ladder& ladder : ladders) {
    if (!ladder.directed) continue;
    double least = 1e9;
    for (const Rung& rung : ladder.rungs) least = std::min(least, rung.chart_error);
    EXPECT_LT(least, 0.9) << ladder.name << ": no rung is any good";
  }
}

}  // namespace
}  // namespace petrichor
