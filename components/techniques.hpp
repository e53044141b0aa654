#pragma once
// Settings of single techniques of falling rain, on the emitter's entity. Every emitter gets them, with these defaults,
// when a scene is opened.

#include <cstdint>
#include <glm/glm.hpp>

namespace petrichor {

// The double cone of Wang and Wade 2004, with the knobs of their tuning tool.
enum class ConeTexture { automatic, drizzle, rain, snow_fine, snow_coarse };
struct DoubleCone {
  bool published = false;        // exactly as printed, with what is known to break
  float camera_damping = 1.0f;   // C_f of eq. 1: 1 is true, less lets the camera's speed tilt the rain less
  float scroll_speed = 1.0f;     // S_f of eq. 3
  float streak_length = 1.0f;    // S_streak of eq. 2
  ConeTexture texture = ConeTexture::automatic;
};

// The layered composite of Tatarchuk and Isidoro 2006, section 3.1, with the artist's controls.
struct LayeredComposite {
  bool published = false;
  glm::vec3 direction{0.0f};  // added to the rain's own velocity, m/s
  float speed = 1.0f;         // multiplies the rain's velocity
  float strength = 1.0f;      // multiplies the drops' opacity; 1 is true
  float milk = 0.0f;          // the paper's bias towards white; 0 is true
};

// The streak sprites of Tariq 2007, with his controls.
struct StreakSprites {
  bool published = false;
  bool freeze = false, hide_rain = false, hide_background = false, simple_shader = false;
  float fraction = 1.0f;  // of the drops that is drawn
  float wind = 1.0f;      // multiplies the wind
  float directional_response = 1.0f, lamp_response = 1.0f;
};

// Falling snow, as a field of flakes.
struct Snowfall {
  float snow_mm_per_hour = 0.0f;  // of water; 1 is 7 to 20 mm of fresh snow
  float drawn_distance_m = 25.0f;
  std::int32_t maximum_flakes = 0;  // 0: what the device affords
  float sway = 1.0f;                // multiplies the flakes' sway
  std::uint32_t seed = 1;
};

}  // namespace petrichor
