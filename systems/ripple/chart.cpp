#include "systems/ripple/ripple.hpp"

namespace petrichor {

Result<void> chart_ripples(const ChartRun&) {
  return {};
}

}  // namespace petrichor
