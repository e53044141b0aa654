// Whole frames of the program against pictures that people looked at and found good. Compared as eyes would (the
// perceptual difference of Yee, Pattanaik and Greenberg 2001, in OpenImageIO), not byte by byte: drivers differ.
// After a wanted change of the look: look at the new pictures, then PETRICHOR_UPDATE_GOLDEN=1 ctest -R golden.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

namespace fs = std::filesystem;
using OIIO::ImageBuf;

struct Shot {
  const char* name;
  const char* arguments;
};

class Golden : public testing::TestWithParam<Shot> {};

TEST_P(Golden, LooksAsItDid) {
  const Shot& shot = GetParam();
  const fs::path golden = fs::path(PETRICHOR_SOURCE_DIR) / "tests/golden" / (std::string(shot.name) + ".png");
  const fs::path made = fs::path(PETRICHOR_BINARY_DIR) / "tests" / (std::string(shot.name) + ".png");
  const std::string command = "\"" PETRICHOR_BINARY_DIR
                              "/petrichor\" render --size 240x136 --set emitter.maximum_drops=20000 --out \"" +
                              made.string() + "\" " + shot.arguments + " 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  if (std::getenv("PETRICHOR_UPDATE_GOLDEN")) {
    fs::copy_file(made, golden, fs::copy_options::overwrite_existing);
    GTEST_SKIP() << golden << " was written anew";
  }
  const ImageBuf expected(golden.string()), actual(made.string());
  ASSERT_TRUE(expected.has_error() == false && expected.spec().width == 240) << golden << ": " << expected.geterror();
  OIIO::ImageBufAlgo::CompareResults result;
  const int different = OIIO::ImageBufAlgo::compare_Yee(actual, expected, result, 100.0f, 45.0f);
  EXPECT_LT(different, 240 * 136 / 50) << "more than 2% of the pixels visibly differ: compare " << made << " with "
                                       << golden;
  // Yee's metric forgives an even shift of brightness; this does not.
  const auto a = OIIO::ImageBufAlgo::computePixelStats(actual), b = OIIO::ImageBufAlgo::computePixelStats(expected);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.avg[c], b.avg[c], 0.02) << "channel " << c;
}

INSTANTIATE_TEST_SUITE_P(
    Pictures, Golden,
    testing::Values(Shot{"first_rain_downpour", "scripts/cinematics/first_rain.lua --frames 210:211"},
                    Shot{"first_rain_dry",
                         "scripts/cinematics/first_rain.lua --frames 210:211 --set emitter.rain_mm_per_hour=0"},
                    Shot{"crossing", "scripts/scenes/city.lua --frames 24:25"},
                    // Three seconds on: who falls through the street sees nothing.
                    Shot{"sandbox", "scripts/sandbox.lua --frames 72:73"}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
