#pragma once
// From Snowfall and Wind to the falling snow of a frame.

#include "components/techniques.hpp"
#include "components/weather.hpp"
#include "engine/ecs/registry.hpp"
#include "systems/first_of.hpp"
#include "systems/frame.hpp"
#include "systems/drops/layers.hpp"
#include "systems/wind_motion.hpp"

namespace petrichor {

// On the entity of the snowfall: how far the wind has carried each class. Written by simulate_snowfall only.
struct SnowMotion {
  WindMotion wind;
};

// The one that snows: the first whose rate is above 0, or else the first.
First<Snowfall> first_snowfall(const Registry&);
// Every tick: it follows the first wind. Without a snowfall it does nothing.
void simulate_snowfall(Registry&, double time_s);

// Fills frame.snow, or leaves it empty where nothing snows. After the camera's extraction: the
// drawn distance is what the budget of flakes allows for this view.
void extract_snowfall(const Registry&, Frame&, double time_s);

// The same from plain values, for bare stages. A maximum of 0 flakes is none: say how many.
WindMotion start_snow_motion(const Wind&);
FrameSnow make_frame_snow(const Snowfall&, const WindMotion&, const FrameCamera&, int width, int height, double time_s);

// How far a flake strays from its place in the class's frame, in diameters, where sway is 1.
constexpr float most_sway_diameters = 10.0f;
// The flakes as a drop field (layers.hpp): diameters are the flakes' largest dimensions. Thinned to a share.
FrameRain flake_field(const FrameSnow&, float share = 1.0f);
// The layers that the view can see; expected.w is the area of a flake, m2.
RainLayers view_flakes(const FrameSnow&, const FrameCamera&, int width, int height);

}  // namespace petrichor
