// The edges of the house (docs: who may include whom), held by scanning every #include of the project.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
const fs::path root = PETRICHOR_SOURCE_DIR;

struct Include {
  std::string from;  // file that includes, relative to the root
  std::string to;
  int line;
};

std::vector<Include> all_includes() {
  std::vector<Include> found;
  const std::regex pattern(R"re(^\s*#\s*include\s*["<]([^">]+)[">])re");
  for (const char* top : {"engine", "components", "systems"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".cpp" && extension != ".hpp" && extension != ".h") continue;
      std::ifstream file(entry.path());
      std::string text;
      std::smatch match;
      for (int line = 1; std::getline(file, text); ++line)
        if (std::regex_search(text, match, pattern))
          found.push_back({fs::relative(entry.path(), root).string(), match[1], line});
    }
  return found;
}

// "engine/gpu/x.hpp" -> "gpu", "components/x.hpp" -> "components", "systems/rainfall/x" -> "systems",
// "engine/main.cpp" and "engine/main/x" -> "main"; "" for what is not ours.
std::string box(const std::string& file) {
  if (file.rfind("components/", 0) == 0) return "components";
  if (file.rfind("systems/", 0) == 0) return "systems";
  if (file.rfind("engine/main", 0) == 0) return "main";
  if (file.rfind("engine/", 0) == 0) return file.substr(7, file.find('/', 7) - 7);
  return "";
}

// The folder of a phenomenon, "" for the files at the root of systems/ and for systems/drops, which all share.
std::string phenomenon(const std::string& file) {
  if (file.rfind("systems/", 0) != 0) return "";
  const auto slash = file.find('/', 8);
  const std::string folder = slash == std::string::npos ? "" : file.substr(8, slash - 8);
  return folder == "drops" ? "" : folder;
}

const std::map<std::string, std::set<std::string>> allowed = {
    {"core", {}},
    {"ecs", {"core"}},
    {"platform", {"core"}},
    {"gpu", {"core"}},
    {"graph", {"core", "gpu"}},
    {"assets", {"core"}},
    {"script", {"core", "ecs"}},
    {"app", {"core"}},
    {"components", {"core", "ecs"}},
    {"systems", {"core", "ecs", "gpu", "graph", "assets", "components"}},
};

TEST(House, IncludesFollowTheEdges) {
  const auto includes = all_includes();
  ASSERT_GT(includes.size(), 100u) << "the scan found too little to mean anything";
  for (const Include& i : includes) {
    const std::string from = box(i.from), to = box(i.to);
    if (to.empty() || from == to || from == "main") continue;
    const auto edges = allowed.find(from);
    ASSERT_NE(edges, allowed.end()) << i.from << ": the box '" << from << "' is not in the plan of the house";
    EXPECT_TRUE(edges->second.count(to)) << i.from << ":" << i.line << ": " << from << " must not include " << to
                                         << " (" << i.to << ")";
  }
}

TEST(House, SystemsNeverIncludeEachOther) {
  for (const Include& i : all_includes()) {
    const std::string from = phenomenon(i.from), to = phenomenon(i.to);
    if (from.empty() || to.empty()) continue;  // the list of systems sees all; everybody sees the shared root
    EXPECT_EQ(from, to) << i.from << ":" << i.line << " includes " << i.to;
  }
}

TEST(House, LibrariesStayBehindTheirWalls) {
  struct Wall {
    const char* prefix;
    std::set<std::string> boxes;
  };
  const std::vector<Wall> walls = {{"lua", {"script"}},
                                   {"tiny_gltf", {"assets"}},
                                   {"OpenImageIO/", {"assets", "app", "systems"}},
                                   {"GLFW/", {"platform", "systems", "main"}},
                                   {"CLI/", {"app"}},
                                   {"epoxy/egl", {"platform"}},
                                   {"imgui", {"systems"}},
                                   {"embree", {"systems"}}};
  for (const Include& i : all_includes())
    for (const Wall& wall : walls) {
      if (i.to.rfind(wall.prefix, 0) != 0) continue;
      EXPECT_TRUE(wall.boxes.count(box(i.from))) << i.from << ":" << i.line << " sees " << i.to;
    }
}

TEST(House, TopLevelFoldersAreTheAgreedOnes) {
  const std::set<std::string> agreed = {"engine",  "systems", "components", "scripts",
                                        "content", "tests",   "docs",       "out"};
  for (const auto& entry : fs::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_directory() || name[0] == '.' || name.rfind("build", 0) == 0) continue;
    EXPECT_TRUE(agreed.count(name)) << name;
  }
}

}  // namespace
