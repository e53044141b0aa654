#pragma once
// Fixture of every test that needs OpenGL: one headless debug context a process, and no GL error left behind.

#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "engine/platform/context.hpp"

namespace petrichor::test {

// Null where there is no OpenGL 4.5.
inline Context* shared_gl_context() {
  static const std::unique_ptr<Context> shared = [] {
    auto made = make_headless_context({.debug = true});
    return made ? *std::move(made) : nullptr;
  }();
  return shared.get();
}

// Base: testing::Test, or TestWithParam. Skips where there is no OpenGL.
template <class Base>
class OnGl : public Base {
 protected:
  void SetUp() override {
    context = shared_gl_context();
    if (!context) GTEST_SKIP() << "no OpenGL 4.5";
    context->make_current();
    errors_before_ = gl_error_count();
  }
  void TearDown() override {
    if (context) {
      EXPECT_EQ(gl_error_count(), errors_before_) << last_gl_error();
    }
  }
  // For a test that makes errors on purpose.
  void expected_errors(int count) { errors_before_ += count; }

  inline static Context* context = nullptr;

 private:
  int errors_before_ = 0;
};

using GlTest = OnGl<::testing::Test>;

// A folder that is the first data root while it lives.
class DataFolder {
 public:
  DataFolder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("petrichor_test_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
    setenv("PETRICHOR_DATA", path_.c_str(), 1);
  }
  ~DataFolder() {
    unsetenv("PETRICHOR_DATA");
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  DataFolder(const DataFolder&) = delete;
  DataFolder& operator=(const DataFolder&) = delete;
  // Each write has a time of its own, however coarse the clock of the file system is.
  void write(const std::string& name, const std::string& text) {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    std::filesystem::last_write_time(file,
                                     std::filesystem::file_time_type::clock::now() + std::chrono::seconds(++writes_));
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int writes_ = 0;
};

}  // namespace petrichor::test
