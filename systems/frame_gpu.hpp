#pragma once
// The last step from the extracted Frame to the GPU: constants and lights.

#include <cstdint>
#include <vector>

#include "engine/gpu/objects.hpp"
#include "systems/frame.hpp"

namespace petrichor {

// Fills frame.uniforms from camera, sky, mist and rain. uniforms.time.z (the simulation step) is kept as it is.
void finish_frame(Frame&);

// Camera-relative world -> clip of a camera that looks along orientation * -z: reversed z with infinite far
// plane (Upchurch and Desbrun 2012), depth = near / axial distance.
glm::mat4 view_projection_of(const glm::quat& orientation, float vertical_fov_rad, float aspect, float near_m);

// cd/m2 -> linear output: saturation-based speed, 1 / (1.2 x 2^EV100) (ISO 12232; Lagarde and de Rousiers 2014).
float exposure_scale(float ev100);

// The distance at which a light is cut. Where the light names none: where its illuminance falls to an amount
// whose reflection off a white wall is `visible_share` of the picture's white.
inline constexpr float visible_share = 0.004f;  // one step of an 8-bit picture
float light_range_m(const FrameLight&, float ev100);

// The lights that can reach something in view, brightest at the camera first (ties by number).
// A light is left out where the sphere of its range lies outside the frustum.
std::vector<LightGpu> visible_lights(const Frame&);

class FrameGpu {
 public:
  // After finish_frame. Uploads and binds constants (FRAME_UNIFORMS_BINDING), lights (LIGHTS_BINDING); with
  // frame.scene, places its instances. Passes may run then.
  void upload(const Frame&);

 private:
  Buffer uniforms_, lights_;
};

}  // namespace petrichor
