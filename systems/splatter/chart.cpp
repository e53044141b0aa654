#include "systems/splatter/splatter.hpp"

namespace petrichor {

Result<void> chart_halos(const ChartRun&) {
  return {};
}

}  // namespace petrichor
