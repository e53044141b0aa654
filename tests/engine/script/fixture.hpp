#pragma once
// A folder of scripts on disk and a world for them.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "components/components.hpp"
#include "engine/script/script.hpp"

namespace petrichor {

class ScriptTest : public testing::Test {
 protected:
  ScriptTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::temp_directory_path() /
             ("petrichor_" + std::to_string(getpid()) + "_" + info->test_suite_name() + "_" + info->name());
    std::filesystem::create_directories(folder);
    options.roots = {folder};
    options.services.print = [this](std::string_view line) { printed.emplace_back(line); };
  }
  ~ScriptTest() override { std::filesystem::remove_all(folder); }

  std::filesystem::path write(const std::string& name, const std::string& text) {
    const auto file = folder / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

  ScriptHost& host() {
    if (!made) made = std::make_unique<ScriptHost>(registry, component_schemas(), options);
    return *made;
  }
  Result<void> run(const std::string& text) { return host().run_file(write("test.lua", text)); }

  // The message of a script that must fail.
  std::string error_of(const std::string& text) {
    const auto result = run(text);
    EXPECT_FALSE(result) << "this script should have failed:\n" << text;
    return result ? "" : result.error().message;
  }
  void expect_ok(const std::string& text) {
    const auto result = run(text);
    EXPECT_TRUE(result) << result.error().message;
  }
  static bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }

  std::filesystem::path folder;
  Registry registry;
  ScriptOptions options;
  std::vector<std::string> printed;
  std::unique_ptr<ScriptHost> made;
};

#define EXPECT_CONTAINS(text, part) EXPECT_TRUE(contains(text, part)) << "the text was: " << (text)

}  // namespace petrichor
