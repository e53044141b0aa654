#include "engine/ecs/schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "engine/core/names.hpp"

namespace petrichor {
namespace {

using Names = std::vector<std::string_view>;
constexpr std::string_view anything = "*";

bool holds(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// The first name that is in both; "*" on the side of `changed` meets everything.
std::string_view common(const Names& changed, const Names& touched) {
  for (const std::string_view name : changed) {
    if (name == anything && !touched.empty()) return touched.front();
    if (holds(touched, name)) return name;
  }
  return {};
}

// What an entry relies on while it runs; `changes` is recorded, and happens later.
Names touched_while_running(const SystemAccess& s) {
  Names all = s.reads;
  all.insert(all.end(), s.writes.begin(), s.writes.end());
  all.insert(all.end(), s.needs.begin(), s.needs.end());
  return all;
}

// What depends on the order of two entries, or "".
std::string_view contested(const SystemAccess& a, const SystemAccess& b) {
  const auto altered = [](const SystemAccess& s) {
    Names all = s.writes;
    all.insert(all.end(), s.changes.begin(), s.changes.end());
    return all;
  };
  const auto touched = [](const SystemAccess& s) {
    Names all = touched_while_running(s);
    all.insert(all.end(), s.changes.begin(), s.changes.end());
    return all;
  };
  if (const std::string_view what = common(altered(a), touched(b)); !what.empty()) return what;
  return common(altered(b), touched(a));
}

}  // namespace

std::string_view phase_name(Phase phase) {
  constexpr std::string_view names[] = {"input", "script", "simulate", "propagate", "extract"};
  return names[static_cast<std::size_t>(phase)];
}

std::vector<std::size_t> run_order(std::span<const SystemAccess> list) {
  std::vector<std::size_t> order(list.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return list[a].phase < list[b].phase; });
  return order;
}

std::vector<Conflict> conflicts(std::span<const SystemAccess> list) {
  const std::size_t n = list.size();
  // follows[b][a]: b is after a. Entries point at earlier ones only, so one pass closes the relation.
  std::vector<std::vector<bool>> follows(n, std::vector<bool>(n, false));
  for (std::size_t b = 0; b < n; ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (list[a].phase != list[b].phase || !holds(list[b].after, list[a].name)) continue;
      follows[b][a] = true;
      for (std::size_t c = 0; c < a; ++c) {
        if (follows[a][c]) follows[b][c] = true;
      }
    }
  }
  std::vector<Conflict> found;
  for (std::size_t b = 0; b < n; ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (list[a].phase != list[b].phase || follows[b][a]) continue;
      if (const std::string_view what = contested(list[a], list[b]); !what.empty()) {
        found.push_back({list[a].name, list[b].name, what});
      }
    }
  }
  return found;
}

std::vector<std::string> problems(std::span<const SystemAccess> list, std::span<const Schema> schemas,
                                  std::span<const std::string_view> resources) {
  Names known(resources.begin(), resources.end());
  for (const Schema& s : schemas) known.push_back(s.name);
  for (const SystemAccess& s : list) known.insert(known.end(), s.writes.begin(), s.writes.end());

  std::vector<std::string> found;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const SystemAccess& s = list[i];
    const auto earlier = list.first(i);
    if (std::any_of(earlier.begin(), earlier.end(), [&](const SystemAccess& e) { return e.name == s.name; })) {
      found.push_back(fmt::format("{}: the name is used twice", s.name));
    }
    for (const std::string_view name : s.after) {
      if (std::none_of(earlier.begin(), earlier.end(),
                       [&](const SystemAccess& e) { return e.name == name && e.phase == s.phase; })) {
        found.push_back(fmt::format("{}: is after \"{}\", which is no earlier entry of the phase {}", s.name, name,
                                    phase_name(s.phase)));
      }
    }
    for (const std::string_view name : s.needs) {
      if (!find_schema(schemas, name))
        found.push_back(fmt::format("{}: needs \"{}\", which has no schema", s.name, name));
    }
    for (const std::string_view name : s.reads) {
      if (!holds(known, name)) {
        found.push_back(fmt::format("{}: reads \"{}\", which nobody writes{}", s.name, name, name_hint(name, known)));
      }
    }
    for (const std::string_view name : s.changes) {
      if (name != anything && !holds(known, name)) {
        found.push_back(
            fmt::format("{}: changes \"{}\", which is no component{}", s.name, name, name_hint(name, known)));
      }
    }
  }
  return found;
}

std::vector<bool> sync_points(std::span<const SystemAccess> ordered) {
  std::vector<bool> before(ordered.size(), false);
  Names pending;
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    if (!common(pending, touched_while_running(ordered[i])).empty()) {
      before[i] = true;
      pending.clear();
    }
    pending.insert(pending.end(), ordered[i].changes.begin(), ordered[i].changes.end());
  }
  return before;
}

}  // namespace petrichor
