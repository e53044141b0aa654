// The streak table: what it must hold, and how its file fails.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "engine/core/paths.hpp"
#include "systems/drops/drop_optics.hpp"
#include "systems/rainfall/streaks/bake.hpp"

namespace petrichor {
namespace {

namespace fs = std::filesystem;
constexpr double degree = std::numbers::pi / 180.0;

StreakBake coarse() {
  StreakBake bake;
  bake.grid = {7, 7, 7};
  bake.along = 8;
  bake.oscillations = 4;
  bake.rays = 2500;
  return bake;
}

const StreakTable& table() {
  static const StreakTable baked = bake_streaks(coarse());
  return baked;
}

struct Folder {
  fs::path path = fs::temp_directory_path() / ("petrichor_streaks_" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() {
    std::error_code ignored;
    fs::permissions(path, fs::perms::owner_all, ignored);
    fs::remove_all(path, ignored);
  }
};

TEST(StreakTable, ModulationAndProfileHaveMeanOne) {
  const StreakTable& t = table();
  const std::size_t states = std::size_t(t.oscillations) * t.along;
  for (int entry = 0; entry < t.grid.entries(); ++entry) {
    double sum = 0.0, across = 0.0;
    for (std::size_t k = 0; k < states; ++k) sum += t.modulation[entry * states + k];
    const auto below = [](double h) { return 0.5 + (h * std::sqrt(1.0 - h * h) + std::asin(h)) / std::numbers::pi; };
    for (int k = 0; k < t.across; ++k)
      across += t.profile[std::size_t(entry) * t.across + k] *
                (below(-1.0 + 2.0 * (k + 1) / t.across) - below(-1.0 + 2.0 * k / t.across));
    EXPECT_NEAR(sum / states, 1.0, 1e-4);
    EXPECT_NEAR(across, 1.0, 1e-4);
  }
  // Reading between entries keeps it: over drops of all phases no rung is brighter than another.
  for (const bool four : {false, true}) {
    double sum = 0.0;
    for (int i = 0; i < 400; ++i)
      sum += streak_modulation(t, {0.31, -0.4, 2.2}, i * 0.61803398875, i * 0.41421356237, four) / 400.0;
    EXPECT_NEAR(sum, 1.0, 0.02);
  }
}

TEST(StreakTable, OfADropThatIsASphereIsEvenAndTheSpheres) {
  StreakBake bake = coarse();
  bake.drop = {0.1, 0.0, 0.0, 45.0, 1.0 / 60.0};
  bake.along = bake.oscillations = 2;
  bake.rays = 20000;
  const StreakTable t = bake_streaks(bake);
  for (int entry = 0; entry < t.grid.entries(); ++entry) {
    EXPECT_NEAR(t.mean[entry], 1.0, 0.08) << entry;  // some nodes get few of the rays
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(t.modulation[4 * entry + k], 1.0, 1e-3);
  }
  const std::vector<float> sphere = make_drop_phase();
  for (int k = 0; k + 8 <= drop_phase_bins; k += 8) {  // eight bins at a time: the rays are few
    double here = 0.0, known = 0.0;
    for (int i = k; i < k + 8; ++i) here += t.phase[i] * (2 * i + 1), known += sphere[i] * (2 * i + 1);
    EXPECT_NEAR(here, known, 0.05 * known) << k;
  }
}

TEST(StreakTable, HoldsAllLightButWhatDropsKeep) {
  // With a lean that is its own mirror image, the half of the lamps that is held stands for all.
  StreakBake bake = coarse();
  bake.drop.lean_deg = 0.0;
  const StreakTable t = bake_streaks(bake);
  const LampGrid lamps{t.grid.light, t.grid.azimuth};
  for (int view = 0; view < t.grid.view; ++view) {
    const double elevation = -90.0 * degree + 180.0 * degree * view / (t.grid.view - 1);
    const TentWeights weights = tent_weights(elevation, lamps, t.phase);
    double sum = 0.0;
    for (int l = 0; l < lamps.light; ++l)
      for (int a = 0; a < lamps.azimuth; ++a) {
        const std::size_t node = std::size_t(l) * lamps.azimuth + a;
        // A pole's ring is one direction, which every node of it holds whole.
        const double share = l == 0 || l + 1 == lamps.light ? 1.0 / lamps.azimuth : 1.0;
        sum += 2.0 * share * weights.phase[node] * t.mean[view * lamps.light * lamps.azimuth + node];
      }
    const auto light = trace_view(bake, elevation, std::span(&lamps, 1), 0, t.oscillations);
    double area = 0.0;
    for (const double a : light.front().area) area += a / light.front().area.size();
    // 0.4% may stay in the drop; the rays on either side are no mirror images.
    EXPECT_NEAR(sum, area, 0.008 * area) << "view " << elevation / degree;
  }
  double whole = 0.0;  // the phase function's own, over all directions: the mean picture's area
  for (int k = 0; k < drop_phase_bins; ++k)
    whole += t.phase[k] * 4.0 * std::numbers::pi * (2 * k + 1) / (double(drop_phase_bins) * drop_phase_bins);
  EXPECT_NEAR(whole, 1.0, 0.03);
}

TEST(StreakTable, FrontIsNotBackAndAboveIsNotLevel) {
  const StreakTable& t = table();
  const auto shine = [&](double view, double light, double azimuth) {
    return streak_phase(t, {view * degree, light * degree, azimuth * degree});
  };
  const auto differ = [&](const StreakAngles& a, const StreakAngles& b) {
    double sum = 0.0;
    for (int i = 0; i < 64; ++i) {
      const double d = streak_modulation(t, a, i / 16.0, i / 64.0) - streak_modulation(t, b, i / 16.0, i / 64.0);
      sum += d * d / 64.0;
    }
    return std::sqrt(sum);
  };
  // Lamp on the eye's side and behind the drop: other light and other bands (physics 3d).
  EXPECT_GT(differ({0.0, 20 * degree, 0.0}, {0.0, 20 * degree, 180 * degree}), 0.2);
  // From 60 degrees above (Tariq reads the same entry as level).
  EXPECT_GT(std::abs(shine(60, 30, 90) / shine(0, 30, 90) - 1.0), 0.3);
  EXPECT_GT(differ({60 * degree, 30 * degree, 90 * degree}, {0.0, 30 * degree, 90 * degree}), 0.2);
  // And a lamp below is no lamp above mirrored: drops are flat below.
  EXPECT_GT(std::abs(shine(0, 60, 0) / shine(0, -60, 0) - 1.0), 0.02);
  EXPECT_EQ(streak_phase(t, {60 * degree, -0.4, 1.0}, true), streak_phase(t, {0.0, 0.4, 1.0}, true));
}

TEST(StreakTable, AnglesAreThoseOfTheGeometry) {
  const StreakAngles a = streak_angles(glm::normalize(glm::dvec3(1, 1, 0)), glm::normalize(glm::dvec3(0, -1, 1)));
  EXPECT_NEAR(a.view_elevation / degree, 45.0, 1e-9);
  EXPECT_NEAR(a.light_elevation / degree, -45.0, 1e-9);
  EXPECT_NEAR(a.azimuth / degree, 90.0, 1e-9);
  EXPECT_NEAR(turn_cosine(streak_angles({0, 0, 1}, {0, 0, -1})), 1.0, 1e-12);  // the drop before the lamp
  EXPECT_NEAR(turn_cosine(streak_angles({0, 0, 1}, {0, 0, 1})), -1.0, 1e-12);
}

TEST(StreakTableFile, ReturnsWhatWasWrittenAndTheSameBytesTwice) {
  Folder folder;
  const std::string one = (folder.path / "one.exr").string(), two = (folder.path / "two.exr").string();
  ASSERT_TRUE(write_streak_table(one, table()));
  StreakBake alone = coarse();
  alone.threads = 1;
  ASSERT_TRUE(write_streak_table(two, bake_streaks(alone)));
  EXPECT_EQ(*read_whole_file(one), *read_whole_file(two));
  const auto read = load_streak_table(one);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->modulation, table().modulation);
  EXPECT_EQ(read->profile, table().profile);
  EXPECT_EQ(read->mean, table().mean);
  EXPECT_EQ(read->phase, table().phase);
  EXPECT_EQ(read->grid.entries(), table().grid.entries());
  EXPECT_FLOAT_EQ(read->drop.diameter_mm, table().drop.diameter_mm);
  // Beside and renamed: nothing else is left.
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()), 2);
}

TEST(StreakTableFile, SaysWhatIsWrong) {
  Folder folder;
  const auto complaint = [](const std::string& file) {
    const auto read = load_streak_table(file);
    EXPECT_FALSE(read);
    const std::string message = read ? "" : read.error().message;
    EXPECT_NE(message.find(file), message.npos) << message;
    EXPECT_NE(message.find("petrichor bake streaks"), message.npos) << message;
    return message;
  };
  complaint((folder.path / "missing.exr").string());
  const std::string junk = (folder.path / "junk.exr").string();
  std::ofstream(junk) << "this is no picture";
  complaint(junk);
  const std::string whole = (folder.path / "whole.exr").string(), cut = (folder.path / "cut.exr").string();
  ASSERT_TRUE(write_streak_table(whole, table()));
  const std::string bytes = *read_whole_file(whole);
  for (const double share : {0.02, 0.3, 0.7, 0.98}) {
    ASSERT_TRUE(write_whole_file(cut, bytes.substr(0, static_cast<std::size_t>(share * bytes.size()))));
    complaint(cut);
  }
  StreakTable dark = table();
  dark.modulation[5] = std::nanf("");
  ASSERT_TRUE(write_streak_table(cut, dark));
  complaint(cut);
  const auto wrong = write_streak_table((folder.path / "table.png").string(), table());
  ASSERT_FALSE(wrong);
  EXPECT_TRUE(wrong.error().wrong_call);
  // A folder that is a file.
  const std::string nowhere = junk + "/table.exr";
  const auto unwritten = write_streak_table(nowhere, table());
  ASSERT_FALSE(unwritten);
  EXPECT_NE(unwritten.error().message.find(nowhere), std::string::npos) << unwritten.error().message;
}

}  // namespace
}  // namespace petrichor
