#include "engine/app/options.hpp"

#include <gtest/gtest.h>

namespace petrichor {
namespace {

ParsedCommandLine parse(std::vector<std::string> words) {
  words.insert(words.begin(), "petrichor");
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  return parse_command_line(static_cast<int>(arguments.size()), arguments.data());
}

TEST(Options, RenderTakesEverything) {
  const auto parsed =
      parse({"render", "a.lua", "--size", "640x360", "--fps", "30", "--frames", "10:20", "--out", "f%04d.png", "--set",
             "emitter.rain_mm_per_hour=50", "--set", "wind.gust_mps=2", "--seed", "9", "--stats", "s.json", "--budget", "66.5"});
  ASSERT_TRUE(parsed.options);
  const auto& render = std::get<RenderOptions>(*parsed.options);
  EXPECT_EQ(render.width, 640);
  EXPECT_EQ(render.height, 360);
  EXPECT_EQ(render.fps, 30.0);
  ASSERT_TRUE(render.frames);
  EXPECT_EQ(render.frames->begin, 10);
  EXPECT_EQ(render.frames->end, 20);
  EXPECT_EQ(render.subject.sets.size(), 2u);
  EXPECT_EQ(render.subject.seed, 9u);
  EXPECT_EQ(render.budget_ms, 66.5);
}

TEST(Options, WithoutABudgetTheDirectorRests) {
  EXPECT_EQ(std::get<RenderOptions>(*parse({"render", "a.lua"}).options).budget_ms, 0.0);
  EXPECT_EQ(std::get<PlayOptions>(*parse({"play"}).options).budget_ms, 0.0);
  EXPECT_EQ(std::get<PlayOptions>(*parse({"play", "--budget", "16"}).options).budget_ms, 16.0);
}

TEST(Options, BakeTakesItsSizes) {
  const auto parsed = parse({"bake", "streaks", "--out", "s.exr", "--views", "5", "--rays", "1000", "--prolate", "0.2"});
  ASSERT_TRUE(parsed.options);
  const auto& bake = std::get<BakeOptions>(*parsed.options);
  EXPECT_EQ(bake.out, "s.exr");
  EXPECT_EQ(bake.views, 5);
  EXPECT_EQ(bake.lights, 0);
  EXPECT_EQ(bake.rays, 1000);
  EXPECT_EQ(bake.prolate, 0.2);
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"bake"}, {"bake", "bread"}, {"bake", "streaks", "--views", "1"}, {"bake", "streaks", "--prolate", "nan"}})
    EXPECT_EQ(parse(words).exit_code, exit_wrong_call);
}

TEST(Options, WrongCallsExitWithTwo) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{},
                                             {"rain"},
                                             {"render"},
                                             {"render", "a.lua", "--size", "640"},
                                             {"render", "a.lua", "--size", "0x4"},
                                             {"render", "a.lua", "--size", "99999x4"},
                                             {"render", "a.lua", "--frames", "5:5"},
                                             {"render", "a.lua", "--frames", "-1:5"},
                                             {"render", "a.lua", "--set", "novalue"},
                                             {"render", "a.lua", "--fps", "0"},
                                             {"render", "a.lua", "--fps", "nan"},
                                             {"render", "a.lua", "--fps", "ten"},
                                             {"render", "a.lua", "--budget", "0"},
                                             {"play", "--budget", "nan"},
                                             {"render", "a.lua", "--nonsense"},
                                             {"measure"},
                                             {"measure", "rain", "--rate", "-1"},
                                             {"measure", "rain", "--rate", "nan"},
                                             {"bench", "--drops", "0"}}) {
    testing::internal::CaptureStderr();
    const auto parsed = parse(words);
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_FALSE(parsed.options);
    EXPECT_EQ(parsed.exit_code, exit_wrong_call);
    EXPECT_FALSE(said.empty());
  }
}

TEST(Options, HelpExitsWithZero) {
  testing::internal::CaptureStdout();
  const auto parsed = parse({"render", "--help"});
  EXPECT_NE(testing::internal::GetCapturedStdout().find("--frames"), std::string::npos);
  EXPECT_EQ(parsed.exit_code, exit_done);
  EXPECT_FALSE(parsed.options);
}

}  // namespace
}  // namespace petrichor
