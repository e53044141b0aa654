#include "systems/occlusion/section.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>

#include "engine/core/paths.hpp"
#include "systems/occlusion/street.hpp"

namespace petrichor {
namespace {

constexpr int across = 176, up = 52;
constexpr glm::vec2 low_m{-4.0f, 0.0f}, high_m{9.2f, 3.9f};

glm::vec3 place_of(int x, int y) {
  const glm::vec2 share((static_cast<float>(x) + 0.5f) / across, (static_cast<float>(y) + 0.5f) / up);
  const glm::vec2 at = low_m + (high_m - low_m) * share;
  return {at.x, at.y, 0.37f};
}

std::string script(const std::string& csv, const std::string& out) {
  constexpr std::array titles{"vertical: one map from above (Chen)", "tilted: one map along the mean fall",
                              "jittered: 8 maps along the falls of all drops", "rays: all drops, all gusts"};
  std::string text;
  for (const auto& [terminal, extension] : {std::pair{"svg size 1100,720 background '#ffffff' font 'sans,12'", "svg"},
                                            std::pair{"pngcairo size 1100,720 font 'sans,11'", "png"}}) {
    text += fmt::format("reset\nset terminal {}\nset output \"{}.{}\"\nset datafile separator ','\n", terminal, out,
                        extension);
    text +=
        "set multiplot layout 2,2 title 'Share of the rain kept away under a roof at 3 m: 10 mm/h, wind of 5 m/s "
        "from the left, with gusts'\n";
    text += "set palette defined (0 '#2b6cb0', 0.5 '#c9d9e8', 1 '#f6e3b4')\nset cbrange [0:1]\nunset key\n";
    text += fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", low_m.x, high_m.x, low_m.y, high_m.y);
    text += "set xlabel 'metres'\nset ylabel 'height, m'\nset colorbox\n";
    text += fmt::format("set object 1 rectangle from -2,{} to 2,{} fc rgb '#444444' fs solid front\n", awning_height_m,
                        awning_height_m + 0.1f);
    for (std::size_t i = 0; i < titles.size(); ++i)
      text += fmt::format("set title '{}'\nplot \"{}\" skip 1 using 1:2:{} with image\n", titles[i], csv, i + 3);
    text += "unset multiplot\n";
  }
  return text;
}

}  // namespace

Result<void> draw_shelter_section(const ChartRun& run, OcclusionStage& stage, const std::vector<FallTruth>& falls) {
  std::vector<ShelterQuestion> places;
  for (int y = 0; y < up; ++y)
    for (int x = 0; x < across; ++x) places.push_back({place_of(x, y)});
  std::vector<std::vector<ShelterAnswer>> answers;
  for (const OcclusionRung rung : {OcclusionRung::vertical, OcclusionRung::tilted, OcclusionRung::jittered}) {
    if (auto loaded = stage.load(1024, 8); !loaded) return loaded;
    stage.frame.techniques.set(Effect::occlusion, rung);
    auto asked = stage.ask(places);
    if (!asked) return tl::unexpected(asked.error());
    answers.push_back(std::move(*asked));
  }
  const ShelterRays rays = stage.rays();
  std::string table = "x_m,height_m,vertical,tilted,jittered,rays\n";
  for (std::size_t i = 0; i < places.size(); ++i) {
    float kept = 0.0f;
    for (const FallTruth& f : falls) kept += rays.sheltered(places[i].place_m, f.velocity_mps) ? f.water : 0.0f;
    const glm::vec3& at = places[i].place_m;
    table += fmt::format("{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}\n", at.x, at.y, answers[0][i].shelter,
                         answers[1][i].shelter, answers[2][i].shelter, kept);
  }
  const std::filesystem::path out = run.folder / "occlusion-section", csv = run.folder / "occlusion-section.csv";
  if (auto written = write_whole_file(csv, table); !written) return written;
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) return {};  // write_chart has said so
  const std::filesystem::path file = run.folder / "occlusion-section.gnuplot";
  if (auto written = write_whole_file(file, script(csv.string(), out.string())); !written) return written;
  const int failed = std::system(fmt::format("gnuplot '{}'", file.string()).c_str());
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  if (failed == 0) std::filesystem::remove(csv, ignored);  // nine thousand rows that the picture shows
  if (failed != 0) return failure(fmt::format("gnuplot failed on the section; the figures are in {}", csv.string()));
  return {};
}

}  // namespace petrichor
