#include "systems/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "engine/core/log.hpp"
#include "engine/core/paths.hpp"

namespace petrichor {
namespace {

constexpr double least_error = 1e-5;  // of the log scale

std::string quoted(const std::string& text) {  // for gnuplot, in double quotes
  std::string out;
  for (const char c : text) out += c == '"' ? "'" : c == '\\' ? "/" : std::string(1, c);
  return '"' + out + '"';
}

std::string table(const Chart& chart) {
  const std::vector<bool> hull = on_hull(chart.points);
  std::string text = fmt::format("# {}, {}x{}, {}; error of two truths of other seeds: {:.5f}\n", chart.title,
                                 chart.width, chart.height, chart.device, chart.floor);
  text += "rung,setting,ms,ms_p5,ms_p95,error,mean_shift,stable,on_hull";
  if (!chart.points.empty())
    for (const auto& [name, value] : chart.points.front().more) text += "," + name;
  text += "\n";
  for (std::size_t i = 0; i < chart.points.size(); ++i) {
    const ChartPoint& p = chart.points[i];
    text += fmt::format("{},{},{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{},{}", p.rung, p.label, p.ms, p.ms_p5, p.ms_p95,
                        p.error, p.mean_shift, int(p.stable), int(hull[i]));
    for (const auto& [name, value] : p.more) text += fmt::format(",{:.6g}", value);
    text += "\n";
  }
  return text;
}

// A gnuplot script; it draws beside itself.
std::string picture(const Chart& chart) {
  const std::vector<bool> hull = on_hull(chart.points);
  const auto shown = [](const ChartPoint& p) { return std::max(p.error, least_error); };
  const auto marks = [&](bool stable) {
    std::string text;
    for (const ChartPoint& p : chart.points)
      if (p.stable == stable) text += fmt::format("{} {} {} {}\n", p.ms, shown(p), p.ms_p5, p.ms_p95);
    return (text.empty() ? std::string("NaN NaN NaN NaN\n") : text) + "e\n";
  };
  std::vector<const ChartPoint*> line;
  for (std::size_t i = 0; i < chart.points.size(); ++i)
    if (hull[i]) line.push_back(&chart.points[i]);
  std::sort(line.begin(), line.end(), [](const ChartPoint* a, const ChartPoint* b) { return a->ms < b->ms; });
  std::string steps, labels;
  for (const ChartPoint* p : line) steps += fmt::format("{} {}\n", p->ms, shown(*p));
  for (const ChartPoint& p : chart.points) {
    std::string name = p.rung;
    std::replace(name.begin(), name.end(), '_', ' ');
    labels += fmt::format("{} {} {}\n", p.ms, shown(p), quoted(p.label.empty() ? name : name + ", " + p.label));
  }
  double low = 1e9, high = 0.0;
  for (const ChartPoint& p : chart.points)
    low = std::min({low, p.ms, p.ms_p5}), high = std::max({high, p.ms, p.ms_p95});
  std::string text;
  for (const auto& [terminal, extension] : {std::pair{"svg size 1000,680 background '#ffffff' font 'sans,12'", "svg"},
                                            std::pair{"pngcairo size 1000,680 font 'sans,11'", "png"}}) {
    text += fmt::format("reset\nset terminal {}\nset output {}\n", terminal, quoted(chart.name + "." + extension));
    text += fmt::format("set title {} noenhanced\n", quoted(chart.title + " (" + chart.device + ")"));
    text += fmt::format("set xlabel {} noenhanced\nset ylabel {} noenhanced\n", quoted(chart.x_label),
                        quoted(chart.error_label));
    text += "set logscale xy\nset grid lc rgb '#dddddd'\nset key bottom left\n";
    text += fmt::format("set xrange [{}:{}]\n", std::max(low, 1e-4) * 0.6, std::max(high, 1e-4) * 3.0);
    if (chart.floor > 0.0) text += fmt::format("floor = {}\n", chart.floor);
    text +=
        "plot '-' using 1:2 with lines lc rgb '#999999' lw 1.5 title 'not dominated', "
        "'-' using 1:2:3:4 with xerrorbars pt 7 ps 1.3 lc rgb '#1f6fb2' title 'stable', "
        "'-' using 1:2:3:4 with xerrorbars pt 6 ps 1.5 lc rgb '#b2571f' title 'fails a stability test', "
        "'-' using 1:2:3 with labels left offset 0.8,0.4 font ',9' noenhanced notitle";
    if (chart.floor > 0.0) text += ", floor with lines dt 2 lc rgb '#b23a1f' title 'two truths, other seeds'";
    text += "\n" + (steps.empty() ? std::string("NaN NaN\n") : steps) + "e\n" + marks(true) + marks(false) +
            (labels.empty() ? std::string("NaN NaN \"\"\n") : labels) + "e\n";
  }
  return text;
}

}  // namespace

std::vector<bool> on_hull(const std::vector<ChartPoint>& points) {
  std::vector<bool> on;
  for (const ChartPoint& p : points)
    on.push_back(std::none_of(points.begin(), points.end(),
                              [&](const ChartPoint& other) { return other.ms < p.ms && other.error < p.error; }));
  return on;
}

Result<void> write_chart(const std::filesystem::path& folder, const Chart& chart) {
  const std::filesystem::path csv = folder / (chart.name + ".csv");
  if (auto written = write_whole_file(csv, table(chart)); !written) return written;
  const std::filesystem::path script = folder / (chart.name + ".gnuplot");
  if (auto written = write_whole_file(script, picture(chart)); !written) return written;
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) {
    log_warn("gnuplot is not installed: {} holds the figures; gnuplot {} draws them, in its folder, where there is one",
             csv.string(), script.filename().string());
    return {};
  }
  const int failed =
      std::system(fmt::format("cd '{}' && gnuplot '{}'", folder.string(), script.filename().string()).c_str());
  std::error_code ignored;
  std::filesystem::remove(script, ignored);
  if (failed != 0) return failure(fmt::format("gnuplot failed on {}; the figures are in {}", chart.name, csv.string()));
  return {};
}

}  // namespace petrichor
