#pragma once
// Splatter on marked objects (shells of spreading rings) and the mist of splashes along their outlines (fins, or a thin
// layer): Tatarchuk and Isidoro 2006, section 3.4. Component RainCatcher marks them.

#include <vector>

#include "engine/assets/model.hpp"
#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/drops/painting.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

// Passes splatter and halos. Both modify colour, behind the scene's depth; without marked things, or rain, neither
// runs. halos: parameter steps, of the layer's closed form along a ray; splatter: parameters
// shells and least_px, across a ring that is drawn; 0: by the device.
std::vector<PassOffer> splatter_passes(const DropPainting&);
// frame.splatter: instances below a RainCatcher. After frame.instances and frame.rain.
void extract_splatter(const Registry&, const std::vector<std::shared_ptr<const Model>>&, Frame&);
Result<void> chart_halos(const ChartRun&);
Ladder splatter_ladder();
Ladder halos_ladder();

}  // namespace petrichor
