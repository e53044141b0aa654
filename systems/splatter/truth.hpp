#pragma once
// The truth of mist: droplets of splashes flown one by one, seen through each pixel.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "systems/frame.hpp"
#include "systems/splatter/shape.hpp"

namespace petrichor {

// One view of one object (its matrix is the identity), against black: cd/m2 from one point lamp, and optical depth,
// both by pixel, row 0 at the bottom. Rain falls straight.
struct MistView {
  FrameCamera camera;
  std::vector<double> light, depth;
};

// droplets: how many are flown, with drag, from where drops of all classes strike the upper surface, until they come
// down on it or fall past it. Every view sees the same ones. hidden: by view, the axial distance of what stands in each
// pixel, m (infinite: nothing).
void fly_mist(const CatcherShape&, const FrameRain&, const FrameLight& lamp, int width, int height, int droplets,
              std::uint32_t seed, const std::vector<std::vector<float>>& hidden, std::vector<MistView>& views);

}  // namespace petrichor
