#include "systems/director/figures.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>

#include "engine/core/paths.hpp"

namespace petrichor {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

bool parse_number(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value) && value >= 0.0;
}

Rung* find_rung(std::vector<Ladder>& ladders, std::string_view effect, std::string_view name) {
  for (Ladder& ladder : ladders)
    if (ladder.name == effect)
      for (Rung& rung : ladder.rungs)
        if (rung.name == name) return &rung;
  return nullptr;
}

}  // namespace

Result<void> read_ladder_figures(std::string_view csv, std::string_view name, std::vector<Ladder>& ladders) {
  std::vector<Ladder> changed = ladders;  // all or nothing
  bool heading_seen = false;
  for (int number = 1; !csv.empty(); ++number) {
    const auto end = csv.find('\n');
    const std::string_view line = trimmed(csv.substr(0, end));
    csv.remove_prefix(end == std::string_view::npos ? csv.size() : end + 1);
    if (line.empty() || line.front() == '#') continue;
    const auto cells = cells_of(line);
    const auto wrong = [&](std::string_view what) { return failure(fmt::format("{}:{}: {}", name, number, what)); };
    if (!std::exchange(heading_seen, true)) {
      if (line != "effect,rung,ms,error,stable") return wrong("expected the heading effect,rung,ms,error,stable");
      continue;
    }
    if (cells.size() != 5) return wrong("expected five cells: effect,rung,ms,error,stable");
    Rung* rung = find_rung(changed, cells[0], cells[1]);
    if (!rung) return wrong(fmt::format("there is no rung {}={}; `petrichor info` lists them", cells[0], cells[1]));
    if (!parse_number(cells[2], rung->chart_ms) || !parse_number(cells[3], rung->chart_error))
      return wrong("ms and error must be numbers, 0 or more");
    if (cells[4] != "0" && cells[4] != "1") return wrong("stable must be 1 or 0");
    rung->stable = cells[4] == "1";
  }
  ladders = std::move(changed);
  return {};
}

Result<void> load_ladder_figures(const std::filesystem::path& file, std::vector<Ladder>& ladders) {
  const auto text = read_whole_file(file);
  if (!text) return tl::unexpected(text.error());
  return read_ladder_figures(*text, file.string(), ladders);
}

}  // namespace petrichor
