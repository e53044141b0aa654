#pragma once
// The surroundings of a place: six views as a small G-buffer, lit, and filtered into the octahedral layout that
// environment.glsl and systems/mirror/probe.glsl read. For the environment near the camera and for probes about
// objects.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "systems/frame.hpp"
#include "systems/lighting/lighting_shared.h"

namespace petrichor {

// A place's six views as a small G-buffer, and what their light adds up to. Each depends on the place, the scene and
// the lights alone, never on the frames before; so a picture does not depend on the way the camera came.
struct EnvironmentProbe {
  glm::ivec3 cell{0};
  std::uint64_t last_used = 0;
  bool captured = false, lit = false;
  std::uint64_t lighting = 0;  // lighting_hash it is lit for
  Texture depth, albedo, normal, emissive, radiance, environment;
  Texture own_light, own_environment;  // luminance of what shines by itself, of the faces and filtered
  Framebuffer framebuffer;
};

struct EnvironmentPrograms {
  const Program& surfaces;  // the G-buffer's, for all materials
  const Program& light;
  const Program& filter;
  const Program& harmonics;
  const Program& diffuse;
  const Program& blend;
};

void make_probe_targets(EnvironmentProbe&);

// The frame that a capture is drawn and lit with: all but its instances and the camera's place, which the caller sets.
Frame frame_around(const Frame&);

// Draws what stands round around.camera.position_m. Leaves around.instances uploaded: upload the frame's own again.
void capture_faces(EnvironmentProbe&, Frame& around, const Program& surfaces);

// Radiance of the six faces, cd/m2, and 1 / distance of what is seen, 1/m, in its alpha (0: the sky). shadow_slots as
// for choose_lights; `lights` is room on the GPU.
void light_faces(EnvironmentProbe&, const Frame& around, std::span<const int> shadow_slots, const Texture* shadow_atlas,
                 const Program& light, Buffer& lights);

// Radiance to the octahedral tiles of probe.environment: for mirror images alone, or with diffuse light. Sets
// probe.lit.
void filter_mirrored(EnvironmentProbe&, const Program& filter);
void filter_faces(EnvironmentProbe&, const EnvironmentPrograms&);

}  // namespace petrichor
