#include "systems/wetness/wetness.hpp"

namespace petrichor {

Result<void> chart_wetness(const ChartRun&) {
  return {};
}

}  // namespace petrichor
