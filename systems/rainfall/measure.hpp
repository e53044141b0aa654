#pragma once
// Counts the rain of the running field on the GPU: the same hash, the same cells and the same moving frames as the
// picture's. Needs a current OpenGL context.

#include <cstdint>
#include <functional>

#include "components/weather.hpp"
#include "engine/core/result.hpp"

namespace petrichor {

struct RainMeasurement {
  double asked_mm_per_hour = 0.0;
  // All water that crossed a level square, of every drop that falls. A part of it falls in drops smaller than
  // the emitter's minimum diameter, which are in the field but never drawn singly:
  double measured_mm_per_hour = 0.0;
  double smaller_drops_mm_per_hour = 0.0;
  // Of drops of at least the minimum diameter:
  double drops_per_m3 = 0.0;         // counted in a cube of air
  double impacts_per_m2_s = 0.0;     // counted through the square
  double mean_fall_speed_mps = 0.0;  // of the drops in the air: impacts over drops
  double seconds = 0.0;
  double area_m2 = 0.0;
  std::uint64_t drops_counted = 0;  // through the square, of any size
};

// Rains for `seconds` (> 0) on a square of 10 m x 10 m. progress gets 0 to 1 and may be empty. Errors: shaders.
Result<RainMeasurement> measure_rain(const Emitter&, const Wind&, double seconds,
                                     const std::function<void(double)>& progress = {});

// Marshall-Palmer rain in an even wind along x.
Result<RainMeasurement> measure_rain(double rain_mm_per_hour, double wind_mps, double seconds, std::uint32_t seed,
                                     const std::function<void(double)>& progress = {});

}  // namespace petrichor
