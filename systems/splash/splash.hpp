#pragma once
// Splashes of the rain and of drips where they land (Tatarchuk and Isidoro 2006, section 3.3): the impacts of the drop
// field itself, found through the maps of shelter. Drawn into the sums of drops, which pass rain_composite lays over
// the picture.

#include <functional>
#include <memory>
#include <vector>

#include "components/weather.hpp"
#include "engine/assets/model.hpp"
#include "engine/core/bench_row.hpp"
#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/drops/painting.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"
#include "systems/splash/splash_shared.h"
#include "systems/splash_frame.hpp"

namespace petrichor {

// splash_overhead (slot overhead: light from above by what is no light, persistent), splash_list (which splashes live)
// and splash_draw (into the sums). Parameters of splash_list:
//   least_radiance            of a white pixel: lamps that cannot make a splash this bright are left out; 0.004
//   software_most, software_reach, software_secondary_reach   what software OpenGL affords at most; 0: as on GPUs
//   software_least_mm         smaller drops' splashes are left out there: they add a few percent of the light
std::vector<PassOffer> splash_passes(const DropPainting&);

// Fills frame.splashes where it rains or drips have landed. After camera, rain, drips, instances and lights.
void extract_splashes(const Registry&, Frame&, const std::vector<std::shared_ptr<const Model>>& models);
// What shines within reach_m of the camera and is no light.
std::vector<SplashGlow> splash_glows(const Frame&, const std::vector<std::shared_ptr<const Model>>& models,
                                     float reach_m);

struct SplashStats {
  std::uint32_t columns = 0, cells = 0, splashes = 0;  // looked at; listed
  float drawn = 0.0f;                                  // of those of the field, on average
  float estimated = 0.0f;                              // alive, by the columns: several times what is there
};
// Of the frame just executed; wait for the GPU.
SplashStats splash_stats();
std::vector<SplashGpu> read_splashes();  // in no order

// The falling rain of an emitter, in still air or wind: systems/rainfall makes it, the list of charts hands it over.
using MakeRain = std::function<FrameRain(const Emitter&, const Wind&, double time_s)>;
Result<void> chart_splashes(const ChartRun&, const MakeRain&);
// Rows splashes/NAME, n: how many were drawn.
Result<std::vector<BenchRow>> bench_splashes(int width, int height, int frames, bool software_gl, const MakeRain&);

Ladder splashes_ladder();

}  // namespace petrichor
