#pragma once
// The command line as plain structs. parse_command_line() is the only place that knows its spelling.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace petrichor {

// What is shown: a Lua script, or any .gltf/.glb, and how it is changed from outside.
struct SubjectOptions {
  std::filesystem::path subject;
  std::vector<std::string> sets;        // "component.field=value"
  std::vector<std::string> techniques;  // "effect=rung"
  std::uint32_t seed = 1;
};

struct FrameRange {
  std::int64_t begin = 0;
  std::int64_t end = 0;  // half open
};

struct PlayOptions {
  SubjectOptions subject;
  int width = 1280, height = 720;
  std::int64_t stop_after_frames = 0;  // 0: until closed
  double budget_ms = 0.0;              // of a frame, for the director; 0: it rests
  std::filesystem::path stats;
};

struct RenderOptions {
  SubjectOptions subject;
  int width = 0, height = 0;  // 0: what the script says, else 1280 x 720
  double fps = 0.0;           // 0: what the script says, else 24
  std::optional<FrameRange> frames;
  std::filesystem::path out;
  std::filesystem::path stats;
  double budget_ms = 0.0;  // of a frame, for the director; 0: it rests
};

struct BenchOptions {
  std::vector<std::string> names;
  std::int64_t drops = 200000;
  int width = 1280, height = 720;
  int frames = 60;
  std::filesystem::path json;
};

struct ChartOptions {
  std::vector<std::string> effects;
  std::filesystem::path out = "docs/charts";
  std::filesystem::path redraw;  // a folder of tables to be drawn again; nothing is measured
};

struct MeasureOptions {
  double rate_mm_per_hour = 10.0;
  double wind_mps = 0.0;
  double seconds = 60.0;
  std::uint32_t seed = 1;
};

struct BakeOptions {
  std::filesystem::path out;      // empty: content/streaks.exr beside the program
  std::filesystem::path picture;  // also a sheet of streaks to look at
  bool fine = false;
  int views = 0, lights = 0, azimuths = 0, along = 0, oscillations = 0, across = 0, rays = 0;  // 0: as small or fine says
  int threads = 2;
  double diameter_mm = 2.0, prolate = 0.1, sideways = 0.05, exposure_s = 1.0 / 60.0;
};

struct InfoOptions {
  bool json = false;
  std::filesystem::path graph;      // write the frame as Graphviz
  std::filesystem::path subject;    // whose frame
  std::filesystem::path reference;  // write the reference page
};

using Options = std::variant<PlayOptions, RenderOptions, BenchOptions, ChartOptions, MeasureOptions, BakeOptions, InfoOptions>;

struct ParsedCommandLine {
  std::optional<Options> options;  // empty: leave with exit_code (help, version, or a wrong call already explained)
  int exit_code = 0;
  bool verbose = false;
};

ParsedCommandLine parse_command_line(int argc, char** argv);

inline constexpr int exit_done = 0;
inline constexpr int exit_failed = 1;
inline constexpr int exit_wrong_call = 2;

}  // namespace petrichor
