#pragma once
// The water behind every edge, as a ledger that any time can be asked of.
//
// A source is a reservoir (the film on its catchment): rain enters, water leaves to the edge at the reservoir's content
// over its time constant. While rain and settings stand still that is closed form, so a source keeps pieces of such
// time ("flows"), not drops: what has come to the edge by any moment is one exponential. Each site of the edge gets its
// share of it, and drop k of a site lets go when that share passes the k-th threshold, which is a function of (source,
// site, k). So which drops hang, fall and have landed at a time follows from the ledger alone: at any step size, in any
// order of frames, for any number of sites, and the camera only says which of them are worth asking about.

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "components/water.hpp"
#include "components/weather.hpp"
#include "engine/assets/model.hpp"
#include "engine/ecs/registry.hpp"
#include "systems/wind_motion.hpp"

namespace petrichor {

class DripSurfaces;  // surfaces.hpp

constexpr double drip_memory_s = 12.0;  // flows and places are known so far back: a fall from 80 m, and a splash

// From time_s on. Of a metre of edge: m2 are m3 a metre.
struct DripFlow {
  double time_s = 0.0, inflow_m2ps = 0.0, runoff_s = 0.0;
  double reservoir_m2 = 0.0, entered_m2 = 0.0, drained_m2 = 0.0;  // at time_s
};

// Where the source stands from a time on.
struct DripPose {
  double from_s;
  std::uint32_t number;
  glm::mat4 matrix;
};

struct DripSourceMotion {
  Entity entity = null_entity;
  DripSource set;
  std::uint32_t seed = 0;
  std::uint32_t life = 0;  // its place among all sources that ever were
  std::uint32_t edge = 0;  // how often its edge was changed
  int sites = 1;
  double drop_m3 = 0.0;                              // mean volume of its drops
  bool wet_at_start = false;                         // it had rained: drops hang at all sites
  double carried_in_m3 = 0.0, carried_out_m3 = 0.0;  // from before its edge was changed
  std::vector<DripFlow> flows;                       // by time
  std::vector<DripPose> poses;                       // by time
};

// On the emitter's entity. Written by simulate_drips only.
struct DripMotion {
  std::vector<DripSourceMotion> sources;
  std::vector<WindMotion> winds;  // by time: each from its anchor on
  std::shared_ptr<DripSurfaces> surfaces;
  std::size_t surface_instances = 0;  // how many mesh instances there were
  std::uint32_t lives = 0;
};

// At a time since drip_memory_s ago. Of a metre of edge.
struct DripWater {
  double entered_m2, reservoir_m2, drained_m2, outflow_m2ps;
};
DripWater water_at(const DripSourceMotion&, double time_s);
// When that much had come to the edge; the flows' times hold.
double time_of_drained(const DripSourceMotion&, double drained_m2);

// A site: where along the edge, and which share of the edge's water (their mean is 1).
struct DripSite {
  double along_m, share, phase;  // phase: of a drop, what hung there at the start
};
DripSite drip_site(const DripSourceMotion&, int site);
double site_water_m3(const DripSourceMotion&, const DripSite&, double drained_m2);
// What must have come to the site for its drop k to let go; 0 at k = -1.
double drip_threshold_m3(const DripSourceMotion&, int site, std::int64_t k);
// How many have let go.
std::int64_t drops_fallen(const DripSourceMotion&, int site, double water_m3);

// entered is what hung and stood there at the start and all that came since:
//   entered = reservoir + pendant + detached.
struct DripLedger {
  double entered_m3 = 0.0, reservoir_m3 = 0.0, pendant_m3 = 0.0, detached_m3 = 0.0;
  double drops = 0.0;  // fallen since its edge was last changed
};
DripLedger drip_ledger(const DripSourceMotion&, double time_s);

const DripPose& pose_at(const DripSourceMotion&, double time_s);
glm::dvec3 drip_wind(const DripMotion&, double time_s);
// Null where there is no emitter, or no source yet.
const DripMotion* find_drip_motion(const Registry&);

}  // namespace petrichor
