#pragma once
// What all that paint single drops share: the optics of drops and the sums that they are drawn into. Made once, by the
// list of passes; passes of rainfall, splashes and drips hold it together.

#include <memory>

#include "systems/drops/optics.hpp"
#include "systems/drops/sums.hpp"

namespace petrichor {

struct DropPainting {
  std::shared_ptr<RainOptics> optics = std::make_shared<RainOptics>();
  std::shared_ptr<RainSums> sums = std::make_shared<RainSums>();
};

}  // namespace petrichor
