#pragma once
// The systems of a frame, run by phase and then in the order of their list. Each says what it reads and
// writes; from that follow the sync points, what is idle, and a test that no order is an accident.

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/ecs/commands.hpp"
#include "engine/ecs/schema.hpp"

namespace petrichor {

enum class Phase { input, script, simulate, propagate, extract };
std::string_view phase_name(Phase);

// What a system touches, by the names of components (their schemas') and of other resources.
struct SystemAccess {
  std::string_view name;
  Phase phase = Phase::simulate;
  std::vector<std::string_view> reads;
  std::vector<std::string_view> writes;   // values; reading them too goes without saying
  std::vector<std::string_view> changes;  // components it adds or removes through Commands; "*": any
  std::vector<std::string_view> needs;    // it runs only while some entity has one of these components
  std::vector<std::string_view> after;    // entries of its phase whose earlier place in the list matters to it
};

// An entry of the list. `after` moves nothing: it says that the order of the list is meant.
template <class Context>
struct SystemEntry {
  std::string_view name;
  Phase phase = Phase::simulate;
  std::vector<std::string_view> reads;
  std::vector<std::string_view> writes;
  std::vector<std::string_view> changes;
  std::vector<std::string_view> needs;
  std::vector<std::string_view> after;
  std::function<void(Context&)> run;
};

// Two entries of one phase of which one writes (or changes) what the other touches, though neither is
// `after` the other, directly or through others.
struct Conflict {
  std::string_view first;
  std::string_view second;
  std::string_view what;
};
std::vector<Conflict> conflicts(std::span<const SystemAccess>);

// Slips in the list, a sentence each: a name used twice, an `after` that names no earlier entry of the
// phase, a need without a schema, a read of what is no schema, no entry writes and `resources` (made
// outside the schedule: "time", "input") does not list.
std::vector<std::string> problems(std::span<const SystemAccess>, std::span<const Schema>,
                                  std::span<const std::string_view> resources);

// Indices by phase, then by place in the list.
std::vector<std::size_t> run_order(std::span<const SystemAccess>);

// For the entries in the order given: whether the commands recorded so far must be applied before each,
// because it touches what an earlier one may have added or removed since the last sync point.
std::vector<bool> sync_points(std::span<const SystemAccess> ordered);

struct SystemStats {
  std::string_view name;
  Phase phase = Phase::simulate;
  std::int64_t runs = 0;
  std::int64_t skips = 0;  // for want of components
  double last_ms = 0.0;    // wall time; what was skipped last took none
};

template <class Context>
class Schedule {
 public:
  // The schemas (which must outlive the schedule) resolve `needs`; an unknown need is a programmer error.
  Schedule(std::vector<SystemEntry<Context>> list, std::span<const Schema> schemas) {
    std::vector<SystemAccess> listed;
    for (const auto& s : list) listed.push_back({s.name, s.phase, s.reads, s.writes, s.changes, s.needs, s.after});
    for (const std::size_t i : run_order(listed)) {
      assert(list[i].run);
      accesses_.push_back(listed[i]);
      stats_.push_back({listed[i].name, listed[i].phase});
      Slot slot{std::move(list[i].run), {}, false};
      for (const std::string_view need : listed[i].needs) {
        const Schema* schema = find_schema(schemas, need);
        assert(schema && "a system needs a component that has no schema");
        if (schema) slot.needs.push_back(schema);
      }
      slots_.push_back(std::move(slot));
    }
    const std::vector<bool> sync = sync_points(accesses_);
    for (std::size_t i = 0; i < slots_.size(); ++i) slots_[i].sync_before = sync[i];
  }

  // Runs the entries of the phases first..last; commands are applied at sync points and at the end.
  void run(Context& context, Registry& registry, Commands& commands, Phase first = Phase::input,
           Phase last = Phase::extract) {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (accesses_[i].phase < first || accesses_[i].phase > last) continue;
      // Before the question whether it is idle: what it needs may be among the commands.
      if (slots_[i].sync_before) commands.apply();
      if (is_idle(slots_[i], registry)) {
        ++stats_[i].skips;
        stats_[i].last_ms = 0.0;
        continue;
      }
      const auto start = std::chrono::steady_clock::now();
      slots_[i].run(context);
      ++stats_[i].runs;
      stats_[i].last_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    }
    commands.apply();
  }

  std::span<const SystemAccess> accesses() const { return accesses_; }  // in run order
  std::span<const SystemStats> stats() const { return stats_; }         // in run order

 private:
  struct Slot {
    std::function<void(Context&)> run;
    std::vector<const Schema*> needs;
    bool sync_before;
  };

  static bool is_idle(const Slot& slot, const Registry& registry) {
    for (const Schema* need : slot.needs) {
      if (need->count(registry) > 0) return false;
    }
    return !slot.needs.empty();
  }

  std::vector<SystemAccess> accesses_;
  std::vector<SystemStats> stats_;
  std::vector<Slot> slots_;
};

}  // namespace petrichor
