#include "engine/core/paths.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

namespace petrichor {
namespace {

namespace fs = std::filesystem;

class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* was = std::getenv(name)) was_ = was;
    if (value)
      ::setenv(name, value, 1);
    else
      ::unsetenv(name);
  }
  ~Environment() {
    if (was_)
      ::setenv(name_, was_->c_str(), 1);
    else
      ::unsetenv(name_);
  }

 private:
  const char* name_;
  std::optional<std::string> was_;
};

class Paths : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("petrichor_paths_" + std::to_string(::getpid()) + "_" + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(folder_);
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::recursive_directory_iterator(folder_), {}));
  }
  fs::path folder_;
};

TEST_F(Paths, WriteAndReadBack) {
  const fs::path file = folder_ / "new" / "deeper" / "rain.txt";
  ASSERT_TRUE(write_whole_file(file, "first"));
  EXPECT_EQ(read_whole_file(file).value(), "first");
  const std::string bytes("nul\0and\xff", 8);
  ASSERT_TRUE(write_whole_file(file, bytes));
  EXPECT_EQ(read_whole_file(file).value(), bytes);
  ASSERT_TRUE(write_whole_file(file, ""));
  EXPECT_EQ(read_whole_file(file).value(), "");
  EXPECT_EQ(files(), 3u) << "nothing may be left beside the file";
}

TEST_F(Paths, PermissionsAndLinksStay) {
  const fs::path file = folder_ / "real", link = folder_ / "link";
  ASSERT_TRUE(write_whole_file(file, "old"));
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real", link);
  ASSERT_TRUE(write_whole_file(link, "new"));
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_whole_file(file).value(), "new");
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("missing", folder_ / "dangling");
  ASSERT_TRUE(write_whole_file(folder_ / "dangling", "made"));
  ASSERT_TRUE(fs::exists(folder_ / "missing"));
  EXPECT_EQ(read_whole_file(folder_ / "missing").value(), "made");
  fs::create_symlink("round", folder_ / "round");
  EXPECT_FALSE(write_whole_file(folder_ / "round", "x")) << "a link to itself";
}

TEST_F(Paths, RefusalsSayWhy) {
  const Result<void> folder = write_whole_file(folder_, "x");
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.error().message.find(folder_.string()), std::string::npos);
  EXPECT_NE(folder.error().message.find("name a file"), std::string::npos);
  ASSERT_TRUE(write_whole_file(folder_ / "file", "x"));
  const Result<void> below_file = write_whole_file(folder_ / "file" / "y", "x");
  ASSERT_FALSE(below_file);
  const Result<std::string> missing = read_whole_file(folder_ / "none");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("No such file"), std::string::npos);
  EXPECT_FALSE(read_whole_file(folder_));
}

TEST_F(Paths, ReadOnlyFolder) {
  ASSERT_TRUE(write_whole_file(folder_ / "kept", "old"));
  fs::permissions(folder_,
                  fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
  const bool was_root = ::geteuid() == 0;  // root may write anywhere, so root does this as nobody
  if (was_root && ::seteuid(65534) != 0) GTEST_SKIP() << "cannot stop being root";
  const Result<void> result = write_whole_file(folder_ / "kept", "new");
  if (was_root && ::seteuid(0) != 0) std::abort();  // later tests must not run as nobody
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("Permission denied; choose a folder"), std::string::npos)
      << result.error().message;
  EXPECT_EQ(read_whole_file(folder_ / "kept").value(), "old");
}

TEST_F(Paths, DiskFull) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const Result<void> result = write_whole_file("/dev/full", "x");
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("No space left"), std::string::npos) << result.error().message;
  EXPECT_NE(result.error().message.find("free some space"), std::string::npos);
  EXPECT_TRUE(fs::is_character_file("/dev/full")) << "a device must not be replaced by a file";
}

TEST_F(Paths, PipesAreWrittenInPlace) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string got;
  std::thread reader([&] { got = read_whole_file(pipe).value_or("failed"); });
  EXPECT_TRUE(write_whole_file(pipe, "through"));
  reader.join();
  EXPECT_EQ(got, "through");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(Paths, FindData) {
  const std::string relative = "petrichor_test_only.txt";
  const Environment data("PETRICHOR_DATA", folder_.c_str());
  EXPECT_EQ(data_roots().front(), folder_);
  const Result<fs::path> missing = find_data(relative);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find(relative), std::string::npos);
  for (const fs::path& root : data_roots()) EXPECT_NE(missing.error().message.find(root.string()), std::string::npos);
  ASSERT_TRUE(write_whole_file(folder_ / relative, "x"));
  EXPECT_EQ(find_data(relative).value(), folder_ / relative);
  EXPECT_EQ(find_data(folder_ / relative).value(), folder_ / relative) << "absolute";
  EXPECT_FALSE(find_data(folder_ / "none"));
  EXPECT_TRUE(find_data("CMakeLists.txt")) << "the source tree is the last place";
}

TEST_F(Paths, DataRootsWithoutTheVariable) {
  const Environment data("PETRICHOR_DATA", nullptr);
  ASSERT_FALSE(executable_folder().empty());
  EXPECT_EQ(data_roots().front(), executable_folder());
  EXPECT_EQ(data_roots()[1].filename(), "petrichor");
  EXPECT_EQ(data_roots().back(), fs::path(PETRICHOR_SOURCE_DIR));
}

TEST_F(Paths, UserFoldersFollowXdg) {
  const Environment home("HOME", "/home/someone");
  {
    const Environment config("XDG_CONFIG_HOME", "/etc/mine"), cache("XDG_CACHE_HOME", nullptr),
        state("XDG_STATE_HOME", "relative");
    EXPECT_EQ(user_config_dir(), "/etc/mine/petrichor");
    EXPECT_EQ(user_cache_dir(), "/home/someone/.cache/petrichor");
    EXPECT_EQ(user_state_dir(), "/home/someone/.local/state/petrichor") << "a relative value is ignored";
  }
  const Environment no_home("HOME", nullptr), no_cache("XDG_CACHE_HOME", nullptr);
  EXPECT_TRUE(user_cache_dir().is_absolute());
}

}  // namespace
}  // namespace petrichor
