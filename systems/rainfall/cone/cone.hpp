#pragma once
// How the double cone of Wang and Wade 2004 stands and moves: its axis (eq. 1), how far its textures are drawn out (eq.
// 2) and scrolled (eq. 3), for rain and for snow.

#include "components/techniques.hpp"
#include "components/weather.hpp"
#include "engine/ecs/registry.hpp"
#include "systems/frame.hpp"
#include "systems/rainfall/cone/textures.hpp"

namespace petrichor {

// Base radius over height of each half of the cone. A cone twists angular speed from apex to base: at an angle psi
// from the axis its texture moves as a drop at distance r does, times (sin psi + slope |cos psi|)^2 / sin psi. At 0.22
// that is within 12% of 1 from 90 down to 20 degrees, where the streaks are handed over to even extinction; a taller
// cone or a cylinder is too slow by sin psi.
constexpr double cone_slope = 0.22;
double cone_speed_ratio(double psi_rad);
// The same beside a drop at the very point of the cone's surface: 1 + slope cot psi (shared physics, section 13).
double cone_surface_speed_ratio(double psi_rad);

// Eq. 2 as printed. Lengths in texels, c_pixel in texels per metre, vec_precip in metres.
double published_elongation(double s_streak, double s_f, double c_pixel, double vec_precip_m);

// The two textures that are mixed, by the rate where the setting is automatic.
struct ConeKinds {
  ConeTexture first, second;
  float second_share;
};
ConeKinds cone_kinds(ConeTexture asked, float mm_per_hour, bool snow);

// What passes the camera.
struct ConeFlow {
  glm::vec3 velocity_mps{0.0f, -6.5f, 0.0f};  // of the precipitation, world; the mean by extinction
  glm::vec3 camera_mps{0.0f};
  float exposure_s = 1.0f / 60.0f;
  float mm_per_hour = 10.0f;
  bool snow = false;
};

// Where the cone stands after a tick; plain values, advanced by advance_cone alone.
struct ConeTrack {
  double time_s = -1.0;  // of that tick; < 0: not started
  glm::vec3 axis{0.0f, -1.0f, 0.0f}, side{1.0f, 0.0f, 0.0f};
  double speed_mps = 0.0;
  std::array<double, cone_layers> phase{}, phase_per_s{};  // mended: wrapped to [0, 1); per second, now
  double scrolled_texels = 0.0;                            // published: the sum of eq. 3, never wrapped
};
void advance_cone(ConeTrack&, const DoubleCone&, const ConeFlow&, double time_s);
// The cone of a frame at time_s, at the track's tick or a little before. step_s: t_delta of the paper.
FrameCone frame_cone(const ConeTrack&, const DoubleCone&, const ConeFlow&, const glm::vec3& camera_radps, float step_s,
                     double time_s);

// For bare stages: fills cone and its onset, as if everything had been so since time 0.
void set_cone(FrameRain&, const DoubleCone&, const FrameCamera&, float step_s, double time_s);
void set_cone(FrameSnow&, const DoubleCone&, const FrameCamera&, float step_s, double time_s);

// On the entity of the emitter (or of the snowfall, where there is no emitter). Written by simulate_cone only.
struct ConeMotion {
  ConeTrack rain, snow;
  glm::vec3 camera_mps{0.0f};  // the last that was known: a jump is no speed
  // The mean fall of the rain, for the emitter's settings that it was made from.
  float rate = -1.0f, gamma_shape = 0.0f, minimum_mm = 0.0f, maximum_mm = 0.0f;
  DropSizes drop_sizes = DropSizes::marshall_palmer;
  double fall_mps = 0.0;
  std::size_t wind_class = 0;  // whose fall is nearest to it
};

// Every tick, after the camera has been tracked.
void simulate_cone(Registry&, double time_s, double step_s);
// After the rain's and the snow's extraction.
void extract_cone(const Registry&, Frame&, double time_s);

}  // namespace petrichor
