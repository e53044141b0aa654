#include "engine/core/names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>
#include <vector>

namespace petrichor {
namespace {

char folded(char c) {
  return c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

// Edit distance in which a swap of neighbours is one slip (optimal string alignment), blind to case and to
// - against _. Three rows of the usual table.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, above, row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = std::exchange(above, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = above[j - 1] + (folded(a[i - 1]) == folded(b[j - 1]) ? 0 : 1);
      row[j] = std::min({replaced, row[j - 1] + 1, above[j] + 1});
      if (i > 1 && j > 1 && folded(a[i - 1]) == folded(b[j - 2]) && folded(a[i - 2]) == folded(b[j - 1])) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

bool contains_folded(std::string_view whole, std::string_view part) {
  return std::search(whole.begin(), whole.end(), part.begin(), part.end(),
                     [](char x, char y) { return folded(x) == folded(y); }) != whole.end();
}

constexpr std::size_t longest_compared = 64;  // hostile input: the work is the product of the lengths

}  // namespace

std::string_view nearest_name(std::string_view wanted, std::span<const std::string_view> known) {
  if (wanted.empty() || wanted.size() > longest_compared) return {};
  std::string_view best;
  std::size_t best_distance = std::max<std::size_t>(1, wanted.size() / 3) + 1;
  for (const std::string_view name : known) {
    if (name.size() > longest_compared) continue;
    if (const std::size_t d = edit_distance(wanted, name); d < best_distance) {
      best = name;
      best_distance = d;
    }
  }
  if (!best.empty() || wanted.size() < 3) return best;
  for (const std::string_view name : known) {  // "rain" for "rain_mm_per_hour"
    if (contains_folded(name, wanted)) return name;
  }
  return {};
}

std::string name_hint(std::string_view wanted, std::span<const std::string_view> known) {
  const std::string_view near = nearest_name(wanted, known);
  const std::string question = near.empty() ? std::string() : fmt::format("; did you mean \"{}\"?", near);
  return fmt::format("{}{} Known: {}", question, near.empty() ? "." : "", fmt::join(known, ", "));
}

}  // namespace petrichor
