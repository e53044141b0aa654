#pragma once
// What --stats writes: times and counts of a run.

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/gpu/timer.hpp"
#include "engine/platform/context.hpp"

namespace petrichor {

struct RunStats {
  std::vector<double> frame_ms;  // wall time around glFinish, first frame left out
  std::vector<std::string> pass_order;
  std::map<std::string, std::vector<double>> pass_ms;
  double start_to_first_frame_s = 0.0;
  void add(const std::vector<Timing>& timings);
};

nlohmann::json to_json(const RunStats&, const DeviceInfo&, int width, int height, std::int64_t frames,
                       std::uint64_t drops_drawn, bool gpu_times);

}  // namespace petrichor
