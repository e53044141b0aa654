#pragma once
// The chart of wet surfaces: rungs against rays, fine steps and photons.

#include <functional>
#include <memory>
#include <span>

#include "engine/assets/model.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/frame.hpp"

namespace petrichor {

// What the chart needs of other folders (systems/systems.cpp gives it).
struct WetTruth {
  std::vector<PassOffer> passes;
  std::shared_ptr<const Model> street;  // with awnings
  // Whether anything stands between a place and the sky, against the way that something falls.
  using Sheltered = std::function<bool(const glm::vec3& place_m, const glm::vec3& velocity_mps)>;
  std::function<Sheltered(std::span<const Model* const>, std::span<const FrameInstance>)> rays;
};

Result<void> chart_wetness(const ChartRun&, const WetTruth&);

}  // namespace petrichor
