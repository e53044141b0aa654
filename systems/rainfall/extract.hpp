#pragma once
// From Emitter and Wind to the falling rain of a frame.

#include <vector>

#include "components/weather.hpp"
#include "engine/ecs/registry.hpp"
#include "systems/frame.hpp"
#include "systems/drops/drop_sizes.hpp"
#include "systems/wind_motion.hpp"

namespace petrichor {

// On the emitter's entity: how far the wind has carried each class. Written by simulate_rainfall only.
struct RainMotion {
  float minimum_diameter_mm = 0.0f, maximum_diameter_mm = 0.0f;  // the classes that it belongs to
  WindMotion wind;
};

// Every tick: the first emitter (by entity) follows the first wind. Without an emitter it does nothing.
void simulate_rainfall(Registry&, double time_s);

// Fills frame.rain, or leaves it empty where there is no emitter or its rate is 0. After the camera's extraction:
// the drawn distance is what the budget of drops allows for this view.
void extract_rainfall(const Registry&, Frame&, double time_s);

// Sets how far the classes are drawn, by asked_distance_m, maximum_drops and the view: drawn_distance_m, fade_start_m,
// mean_reach, expected_drops and each class's reach.
void fit_distance(FrameRain&, const FrameCamera&, int width, int height);

// The first (by entity), or still air.
Wind first_wind(const Registry&);

// The same from plain values, for measuring and tests.
WindMotion start_rain_motion(const Emitter&, const Wind&, int drawn = drawn_classes);
// `drawn` as the motion was started with.
FrameRain make_frame_rain(const Emitter&, const WindMotion&, const FrameCamera&, int width, int height, double time_s,
                          int drawn = drawn_classes);

}  // namespace petrichor
