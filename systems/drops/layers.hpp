#pragma once
// The drop field as the GPU enumerates it: boxes of cells, one per layer of a class.
//
// A class of density n is a stack of layers: the first holds up to its base density, each further one as much
// as all below it. So drops stay where they are while the rate changes, cells hold as many drops at
// drizzle as in a downpour, and no drop is enumerated that is not there: the highest layer is filled in part,
// each cell drop by drop (field.glsl).

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "systems/frame.hpp"
#include "systems/drops/rain_shared.h"

namespace petrichor {

// Mean; RAIN_LANES invocations share a cell, by turns. 56 took a quarter less time than 28 on an H200: the last turn is
// seldom nearly empty, and there are half as many cells.
constexpr float drops_per_full_cell = 56.0f;

struct RainLayer {
  float edge_m;    // of its cells
  float expected;  // mean drops in a cell now
};
std::vector<RainLayer> layers_of(const RainClass&);  // empty at density 0

// The part of space whose drops are wanted, relative to some reference, as a box when the shutter closes.
struct RainBox {
  glm::dvec3 low, high;
};

// Every cell of the classes that `wanted` names and that touches its box. `reference` is the origin (world)
// that the boxes and the result are relative to. `candidates` is the total number of cells.
struct RainLayers {
  std::vector<RainLayerGpu> layers;
  std::uint64_t candidates = 0;
};
RainLayers layers_in(const FrameRain&, const glm::dvec3& reference,
                     const std::function<bool(const RainClass&, RainBox&)>& wanted);

// The box of what a camera sees to a distance, relative to it, while the shutter is open.
RainBox view_box(const FrameCamera&, int width, int height, float distance_m);
RainLayers view_layers(const FrameRain&, const FrameCamera&, int width, int height);
double candidate_cells(const FrameRain&, const FrameCamera&, int width, int height, float distance_m);  // estimate

}  // namespace petrichor
