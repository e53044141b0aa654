#include "systems/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "engine/core/log.hpp"
#include "engine/core/paths.hpp"

namespace petrichor {
namespace {

constexpr double least_error = 1e-5;  // of the log scale

std::string in_quotes(const std::string& text) {  // for gnuplot, in double quotes
  std::string out;
  for (const char c : text) out += c == '"' ? "'" : c == '\\' ? "/" : std::string(1, c);
  return '"' + out + '"';
}

// Cells of a line of a table; a comma within quotes is part of its cell.
std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  bool inside = false;
  for (const char c : line) {
    if (c == '"')
      inside = !inside;
    else if (c == ',' && !inside)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

std::string cell(const std::string& text) {
  return text.find(',') == text.npos ? text : '"' + text + '"';
}

std::string table(const Chart& chart) {
  const std::vector<bool> hull = on_hull(chart.points);
  std::string text;
  for (const auto& [key, value] :
       {std::pair<const char*, std::string>{"title", chart.title},
        {"effect", chart.effect},
        {"device", chart.device},
        {"size", fmt::format("{}x{}", chart.width, chart.height)},
        {"x", chart.x_label},
        {"y", chart.error_label},
        {"floor, the error of two truths of other seeds", fmt::format("{:.6f}", chart.floor)}})
    text += fmt::format("# {}: {}\n", key, value);
  text += "rung,setting,ms,ms_p5,ms_p95,error,mean_shift,stable,on_hull";
  if (!chart.points.empty())
    for (const auto& [name, value] : chart.points.front().more) text += "," + name;
  text += "\n";
  for (std::size_t i = 0; i < chart.points.size(); ++i) {
    const ChartPoint& p = chart.points[i];
    text += fmt::format("{},{},{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{},{}", cell(p.rung), cell(p.label), p.ms, p.ms_p5,
                        p.ms_p95, p.error, p.mean_shift, int(p.stable), int(hull[i]));
    for (const auto& [name, value] : p.more) text += fmt::format(",{:.6g}", value);
    text += "\n";
  }
  return text;
}

// Beside each mark its name, moved up or down where another's stands already.
std::string label_lines(const Chart& chart, double left, double right, double bottom, double top) {
  constexpr double letter = 0.0078, line = 0.026;  // of the plot's width and height
  struct Box {
    double x, y, wide;
  };
  std::vector<Box> taken;
  std::string lines;
  for (const ChartPoint& p : chart.points) {
    std::string name = p.rung;
    std::replace(name.begin(), name.end(), '_', ' ');
    if (!p.label.empty()) name += ", " + p.label;
    Box box{std::log(std::max(p.ms, left) / left) / std::log(right / left) + 0.012,
            std::log(std::max(p.error, least_error) / bottom) / std::log(top / bottom), letter * double(name.size())};
    const double at_mark = box.y;
    const auto free_here = [&] {
      return std::none_of(taken.begin(), taken.end(), [&](const Box& other) {
        return std::abs(other.y - box.y) < line && box.x < other.x + other.wide && other.x < box.x + box.wide;
      });
    };
    for (int i = 0; i < 24; ++i) {
      box.y = at_mark + (i % 2 ? -1.0 : 1.0) * 0.5 * line * (i + 1);
      if (free_here()) break;
    }
    taken.push_back(box);
    lines += fmt::format("set label {} at graph {:.4f},{:.4f} left font ',9' noenhanced\n", in_quotes(name), box.x, box.y);
  }
  return lines;
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
  std::string steps;
  for (const ChartPoint* p : line) steps += fmt::format("{} {}\n", p->ms, shown(*p));
  double low = 1e9, high = 0.0;
  for (const ChartPoint& p : chart.points)
    low = std::min({low, p.ms, p.ms_p5}), high = std::max({high, p.ms, p.ms_p95});
  double least = 1e9, most = 0.0;
  for (const ChartPoint& p : chart.points) least = std::min(least, shown(p)), most = std::max(most, shown(p));
  if (chart.floor > 0.0) least = std::min(least, chart.floor), most = std::max(most, chart.floor);
  const double left = std::max(low, 1e-4) * 0.6, right = std::max(high, 1e-4) * 3.0;
  const double bottom = least * 0.4, top = most * 1.6;
  const std::string labels = label_lines(chart, left, right, bottom, top);
  std::string text;
  for (const auto& [terminal, extension] : {std::pair{"svg size 1000,680 background '#ffffff' font 'sans,12'", "svg"},
                                            std::pair{"pngcairo size 1000,680 font 'sans,11'", "png"}}) {
    text += fmt::format("reset\nset terminal {}\nset output {}\n", terminal, in_quotes(chart.name + "." + extension));
    text += fmt::format("set title {} noenhanced\n", in_quotes(chart.title + " (" + chart.device + ")"));
    text += fmt::format("set xlabel {} noenhanced\nset ylabel {} noenhanced\n", in_quotes(chart.x_label),
                        in_quotes(chart.error_label));
    text += "set logscale xy\nset grid lc rgb '#dddddd'\nset key bottom left\n";
    text += fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", left, right, bottom, top) + labels;
    if (chart.floor > 0.0) text += fmt::format("floor = {}\n", chart.floor);
    text +=
        "plot '-' using 1:2 with lines lc rgb '#999999' lw 1.5 title 'not dominated', "
        "'-' using 1:2:3:4 with xerrorbars pt 7 ps 1.3 lc rgb '#1f6fb2' title 'stable', "
        "'-' using 1:2:3:4 with xerrorbars pt 6 ps 1.5 lc rgb '#b2571f' title 'fails a stability test'";
    if (chart.floor > 0.0) text += ", floor with lines dt 2 lc rgb '#b23a1f' title 'two truths, other seeds'";
    text += "\n" + (steps.empty() ? std::string("NaN NaN\n") : steps) + "e\n" + marks(true) + marks(false);
  }
  return text;
}

}  // namespace

std::vector<bool> on_hull(const std::vector<ChartPoint>& points) {
  std::vector<bool> on;
  for (const ChartPoint& p : points)
    on.push_back(p.stable && std::none_of(points.begin(), points.end(), [&](const ChartPoint& other) {
                   return other.stable && other.ms < p.ms && other.error < p.error;
                 }));
  return on;
}

Result<void> write_chart(const std::filesystem::path& folder, const Chart& chart) {
  const std::filesystem::path csv = folder / (chart.name + ".csv");
  if (auto written = write_whole_file(csv, table(chart)); !written) return written;
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) {
    log_warn("gnuplot is not installed, so {} is without a picture; `petrichor chart --redraw {}` makes it where it is",
             csv.string(), folder.string());
    return {};
  }
  const std::filesystem::path script = folder / (chart.name + ".gnuplot");
  if (auto written = write_whole_file(script, picture(chart)); !written) return written;
  const int failed =
      std::system(fmt::format("cd '{}' && gnuplot '{}'", folder.string(), script.filename().string()).c_str());
  std::error_code ignored;
  std::filesystem::remove(script, ignored);
  if (failed != 0) return failure(fmt::format("gnuplot failed on {}; the figures are in {}", chart.name, csv.string()));
  return {};
}

Result<Chart> read_chart(const std::filesystem::path& csv) {
  std::ifstream file(csv);
  if (!file) return failure(fmt::format("cannot read {}", csv.string()));
  Chart chart;
  chart.name = csv.stem().string();
  std::vector<std::string> columns;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.rfind("# ", 0) == 0) {
      const auto colon = line.find(": ");
      const std::string key = line.substr(2, colon - 2), value = colon == line.npos ? "" : line.substr(colon + 2);
      if (key == "title") chart.title = value;
      if (key == "effect") chart.effect = value;
      if (key == "device") chart.device = value;
      if (key == "x") chart.x_label = value;
      if (key == "y") chart.error_label = value;
      if (key == "size") std::sscanf(value.c_str(), "%dx%d", &chart.width, &chart.height);
      if (key.rfind("floor", 0) == 0) chart.floor = std::atof(value.c_str());
      continue;
    }
    std::vector<std::string> cells = split(line);
    if (columns.empty()) {
      columns = cells;
      if (columns.size() < 9 || columns[0] != "rung")
        return failure(fmt::format("{}:{}: not a chart's table: it begins rung,setting,ms,...", csv.string(), number));
      continue;
    }
    if (cells.size() != columns.size())
      return failure(fmt::format("{}:{}: {} columns, not {}", csv.string(), number, cells.size(), columns.size()));
    const auto value = [&](std::size_t i) { return std::atof(cells[i].c_str()); };
    chart.points.push_back({cells[0], cells[1], value(2), value(3), value(4), value(5), value(6), cells[7] == "1", {}});
    for (std::size_t i = 9; i < columns.size(); ++i) chart.points.back().more.emplace_back(columns[i], value(i));
  }
  if (chart.points.empty()) return failure(fmt::format("{}: holds no points", csv.string()));
  if (chart.title.empty()) return failure(fmt::format("{}: has no '# title: ' line", csv.string()));
  return chart;
}

Result<void> redraw_charts(const std::filesystem::path& folder) {
  std::error_code failed;
  std::vector<std::filesystem::path> tables;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed))
    if (entry.path().extension() == ".csv") tables.push_back(entry.path());
  if (failed || tables.empty()) return failure(fmt::format("{}: no tables of charts (.csv) here", folder.string()));
  std::sort(tables.begin(), tables.end());
  for (const std::filesystem::path& csv : tables) {
    const auto chart = read_chart(csv);
    if (!chart) return tl::unexpected(chart.error());
    if (auto written = write_chart(folder, *chart); !written) return written;
  }
  return {};
}

}  // namespace petrichor
