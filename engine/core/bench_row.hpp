#pragma once
// One case of a benchmark, as `petrichor bench` prints it.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace petrichor {

struct BenchRow {
  std::string name;  // "ecs/iterate_2"
  std::string n;     // how many: "1000000"
  std::string size;  // of the picture, "" where there is none
  double median_ms = 0.0;
  double p95_ms = 0.0;
  std::optional<double> gpu_median_ms;  // only where a GPU timer is real
};

// The value that `share` (0 to 1) of the samples do not exceed, by the nearest rank: 0.5 the median,
// 0.95 the p95. The samples may come in any order; 0 for none.
inline double quantile(std::vector<double> samples, double share) {
  if (samples.empty()) return 0.0;
  std::sort(samples.begin(), samples.end());
  const double rank = share * static_cast<double>(samples.size() - 1) + 0.5;
  return samples[std::min(samples.size() - 1, static_cast<std::size_t>(rank))];
}

}  // namespace petrichor
