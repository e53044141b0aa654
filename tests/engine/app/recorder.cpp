#include "engine/app/recorder.hpp"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <vector>

namespace petrichor {
namespace {

namespace fs = std::filesystem;

struct Recording : testing::Test {
  void SetUp() override {
    folder = fs::temp_directory_path() / ("petrichor_recorder_" + std::to_string(getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  std::size_t files() const { return std::distance(fs::directory_iterator(folder), {}); }
  fs::path folder;
};

// Red at the top, green at the bottom; rows from the bottom as OpenGL gives them.
std::vector<std::uint8_t> two_rows() {
  return {0, 255, 0, 255, 0, 255, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255};
}

TEST_F(Recording, PngHasTheTopRowFirst) {
  const auto pixels = two_rows();
  const auto target = record_target(folder / "a.png", 1);
  ASSERT_TRUE(target);
  auto recorder = make_recorder(*target, 2, 2, 24);
  ASSERT_TRUE(recorder);
  ASSERT_TRUE((*recorder)->add(0, Picture{2, 2, pixels, {}}));
  ASSERT_TRUE((*recorder)->finish());
  auto input = OIIO::ImageInput::open((folder / "a.png").string());
  ASSERT_TRUE(input);
  std::vector<std::uint8_t> back(2 * 2 * 3);
  ASSERT_EQ(input->spec().nchannels, 3);
  input->read_image(0, 0, 0, -1, OIIO::TypeDesc::UINT8, back.data());
  EXPECT_EQ(back[0], 255);
  EXPECT_EQ(back[1], 0);
  EXPECT_EQ(back[6], 0);
  EXPECT_EQ(back[7], 255);
  EXPECT_EQ(files(), 1u) << "the file written beside must be gone";
}

TEST_F(Recording, ExrKeepsLightBeyondWhite) {
  const std::vector<float> pixels{40.0f, 0.25f, 0.0f, 1.0f};
  const auto target = record_target(folder / "a.exr", 1);
  auto recorder = make_recorder(*target, 1, 1, 24);
  ASSERT_TRUE((*recorder)->add(0, Picture{1, 1, {}, pixels}));
  auto input = OIIO::ImageInput::open((folder / "a.exr").string());
  ASSERT_TRUE(input);
  float back[3];
  input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, back);
  EXPECT_FLOAT_EQ(back[0], 40.0f);
  EXPECT_FLOAT_EQ(back[1], 0.25f);
}

TEST_F(Recording, PatternsAreChecked) {
  EXPECT_TRUE(record_target("f%04d.png", 100));
  EXPECT_TRUE(record_target("f%d.exr", 100));
  for (const char* bad :
       {"f%s.png", "f%04d%04d.png", "f%n.png", "f%.png", "f%99999d.png", "film%d.mp4", "film", "film.txt"})
    EXPECT_FALSE(record_target(bad, 2)) << bad;
  EXPECT_FALSE(record_target("one.png", 2));
  EXPECT_EQ(numbered_file("a/f%04d.png", 17), fs::path("a/f0017.png"));
  EXPECT_EQ(numbered_file("f%d.png", 17), fs::path("f17.png"));
}

TEST_F(Recording, AnUnwritableFolderIsAMessageNamingTheFile) {
  std::ofstream(folder / "plain") << "a file, not a folder";
  const auto target = record_target(folder / "plain" / "a.png", 1);
  const auto recorder = make_recorder(*target, 2, 2, 24);
  ASSERT_FALSE(recorder);
  EXPECT_NE(recorder.error().message.find("plain"), std::string::npos);
}

TEST_F(Recording, AFilmThatCannotBeWrittenSaysSoAtOnce) {
  // A dangling link stands for a folder that takes no new files: root may write anywhere else.
  fs::create_symlink("/proc/no such folder/log", folder / ".a.part.mp4.log");
  const auto recorder = make_recorder(*record_target(folder / "a.mp4", 3), 2, 2, 24);
  ASSERT_FALSE(recorder);
  if (recorder.error().message.find("not installed") != std::string::npos) GTEST_SKIP() << recorder.error().message;
  EXPECT_NE(recorder.error().message.find("cannot write " + (folder / "a.mp4").string()), std::string::npos)
      << recorder.error().message;
}

TEST_F(Recording, ATargetThatMakesNoSenseIsAWrongCall) {
  const auto target = record_target("film.txt", 1);
  ASSERT_FALSE(target);
  EXPECT_TRUE(target.error().wrong_call);
}

TEST_F(Recording, AFailedPictureLeavesWhatWasThere) {
  fs::create_directories(folder / "a.png");  // in the way of the renaming
  std::ofstream(folder / "a.png" / "inside") << "precious";
  const auto pixels = two_rows();
  RecordTarget target{RecordKind::png, folder / "a.png", false};
  auto recorder = make_recorder(target, 2, 2, 24);
  const auto added = (*recorder)->add(0, Picture{2, 2, pixels, {}});
  ASSERT_FALSE(added);
  EXPECT_NE(added.error().message.find("a.png"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "a.png" / "inside"));
  EXPECT_EQ(files(), 1u) << "nothing half-written stays";
}

TEST_F(Recording, FilmIsWholeOrAbsent) {
  const auto target = record_target(folder / "a.mp4", 3);
  auto recorder = make_recorder(*target, 2, 2, 24);
  if (!recorder) GTEST_SKIP() << recorder.error().message;
  const auto pixels = two_rows();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE((*recorder)->add(i, Picture{2, 2, pixels, {}}));
  EXPECT_FALSE(fs::exists(folder / "a.mp4"));
  const auto finished = (*recorder)->finish();
  ASSERT_TRUE(finished) << finished.error().message;
  recorder->reset();
  EXPECT_GT(fs::file_size(folder / "a.mp4"), 100u);
  EXPECT_EQ(files(), 1u);

  auto abandoned = make_recorder(*record_target(folder / "b.mp4", 3), 2, 2, 24);
  ASSERT_TRUE((*abandoned)->add(0, Picture{2, 2, pixels, {}}));
  abandoned->reset();
  EXPECT_EQ(files(), 1u);
}

TEST_F(Recording, WithoutFfmpegTheMessageNamesTheWayOut) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.c_str(), 1);
  const auto recorder = make_recorder(*record_target(folder / "a.mp4", 3), 2, 2, 24);
  setenv("PATH", path.c_str(), 1);
  ASSERT_FALSE(recorder);
  EXPECT_NE(recorder.error().message.find("ffmpeg"), std::string::npos);
  EXPECT_NE(recorder.error().message.find("%04d.png"), std::string::npos);
}

}  // namespace
}  // namespace petrichor
