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
  float parallax = 1.0f;         // S_f of eq. 2: multiplies how much farther away each layer looks than the first
  float scroll_speed = 1.0f;     // multiplies D_precip of eq. 3
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
  float parallax = 1.0f;      // p_r of the published setting: spread of the layers' distances
  float rain_contrast = 1.0f;  // k_c: how much lightning changes the drops
  float lightning_1 = 0.0f, lightning_2 = 0.0f;  // L_1, L_2: brightness of two flashes now; scripts drive them
};

// The streak sprites of Tariq 2007, with his controls.
struct StreakSprites {
  bool published = false;
  bool freeze = false, hide_rain = false, hide_background = false, simple_shader = false;
  float fraction = 1.0f;  // of the drops that is drawn
  float wind = 1.0f;      // multiplies the wind
  float directional_response = 1.0f, lamp_response = 1.0f;
};

// Near drops that show the world refracted (Rana), with what his maps are made of.
struct NearDrops {
  bool published = false;        // exactly as printed: the world 5 m away on all sides, no drop nearer than 2 m
  float least_width_px = 1.0f;   // of a drop's image, to be drawn so
  std::int32_t most_drops = 4096;  // in view, on average; more make the least width larger
  float step_m = 1.0f;           // the surroundings are captured again when the camera has moved this far
  std::int32_t map_cells = 20;   // of the technique near_drops=maps: cells along a side of 10 m
  std::int32_t map_pixels = 16;  // along a side of each map; printed: about 32 (24 KB a map)
};

// Falling snow, as a field of flakes.
struct Snowfall {
  float snow_mm_per_hour = 0.0f;  // of water; 1 is 7 to 20 mm of fresh snow
  float drawn_distance_m = 25.0f;
  std::int32_t maximum_flakes = 0;  // 0: what the device affords
  float sway = 1.0f;                // multiplies the flakes' sway
  float cone_jitter = 1.0f;         // of snow=double_cone: multiplies its textures' sway; 0: as printed
  std::uint32_t seed = 1;
};

}  // namespace petrichor
