#include "systems/drip/drip.hpp"

namespace petrichor {

Result<void> chart_drips(const ChartRun&) {
  return {};
}

}  // namespace petrichor
