#pragma once
// From components to the Frame: camera, instances and lights.

#include "engine/ecs/registry.hpp"
#include "systems/frame.hpp"

namespace petrichor {

// At the end of the propagate phase of every tick: remembers where each camera is (CameraMotion).
void track_cameras(Registry&);

// The first active camera (by entity), between its last two ticks: interpolation 0 is the older, 1 the newer.
// Velocities are zero on the first tick and after a jump of more than 50 m. Without a camera frame.camera is left
// alone. step_s: simulation step.
inline constexpr float camera_jump_m = 50.0f;
void extract_camera(const Registry&, Frame&, double interpolation, double step_s);

// MeshInstance and WorldTransform; sets geometry_version (a hash: equal content, equal version).
void extract_instances(const Registry&, Frame&);

// Light and WorldTransform; sets lights_version: a hash of what shadow maps depend on (place, direction, cone,
// range of lights that cast shadows), not of intensity, so that a flickering lamp redraws nothing.
void extract_lights(const Registry&, Frame&);

}  // namespace petrichor
