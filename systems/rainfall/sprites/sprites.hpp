#pragma once
// Streak sprites (Tariq 2007): from the settings of StreakSprites to the particles of a frame.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "components/techniques.hpp"
#include "engine/ecs/registry.hpp"
#include "systems/frame.hpp"
#include "systems/rainfall/sprites/sprites_shared.h"

namespace petrichor {

// On the emitter's entity: what freezing the drops and multiplying the wind made of their way so far, by class. Zero
// while neither was ever done, so that any frame stands alone. Written by simulate_sprites only.
struct SpriteMotion {
  double time_s = 0.0;              // of the last tick
  std::vector<glm::dvec3> drift_m;  // the wind's part of each class's way, then
  std::vector<glm::dvec3> offset_m;
};

void simulate_sprites(Registry&, double time_s);               // after simulate_rainfall
void extract_sprites(const Registry&, Frame&, double time_s);  // after extract_rainfall

// The same from plain values: offset_m is empty. The box's edge is twice asked_distance_m, or less in steps of a fifth,
// so that at most sprites_per_drop * maximum_drops particles fill it.
FrameSprites make_frame_sprites(const StreakSprites&, const FrameRain&);
// The budget is one of drops that are drawn; of a box about the camera a view of 60 degrees sees a twentieth.
constexpr double sprites_per_drop = 8.0;

// The drawn classes of the frame as the shaders have them, for particles in that number and `share` of the rain.
struct SpriteClasses {
  std::vector<SpriteClassGpu> classes;  // those that hold a particle; published: all
  std::uint32_t particles = 0;
};
SpriteClasses sprite_classes(const FrameRain&, const glm::dvec3& camera_m, double share);

// The wind as the particles feel it, times StreakSprites::wind: of class k, m/s.
glm::vec3 sprite_wind(const FrameRain&, std::size_t k);

}  // namespace petrichor
