#include "engine/main/stats.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/core/bench_row.hpp"

namespace petrichor {

void RunStats::add(const std::vector<Timing>& timings) {
  for (const Timing& timing : timings) {
    auto [at, added] = pass_ms.try_emplace(timing.name);
    if (added) pass_order.push_back(timing.name);
    at->second.push_back(timing.milliseconds);
  }
}

nlohmann::json to_json(const RunStats& stats, const DeviceInfo& device, int width, int height, std::int64_t frames,
                       std::uint64_t drops_drawn, bool gpu_times) {
  nlohmann::json passes = nlohmann::json::array();
  for (const std::string& name : stats.pass_order) {
    const auto& times = stats.pass_ms.at(name);
    passes.push_back({{"name", name},
                      {"ms_median", quantile(times, 0.5)},
                      {"ms_p95", quantile(times, 0.95)},
                      {"runs", times.size()}});
  }
  return {{"device",
           {{"renderer", device.renderer},
            {"vendor", device.vendor},
            {"version", device.version},
            {"software", device.software}}},
          {"size", fmt::format("{}x{}", width, height)},
          {"frames", frames},
          {"start_to_first_frame_s", stats.start_to_first_frame_s},
          {"frame_ms", {{"median", quantile(stats.frame_ms, 0.5)}, {"p95", quantile(stats.frame_ms, 0.95)}}},
          {"passes", passes},
          {"pass_times", gpu_times ? "GPU timers" : "wall time around glFinish"},
          {"techniques", nlohmann::json::object()},
          {"rain", {{"drops_drawn", drops_drawn}}}};
}

}  // namespace petrichor
