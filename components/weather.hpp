#pragma once
#include <cstdint>
#include <glm/glm.hpp>

namespace petrichor {

enum class DropSizes { marshall_palmer, gamma };

// Falling rain. The rate and the drop sizes are all there is to say; counts, speeds, streaks,
// extinction and impacts follow from them (shared physics, sections 1 and 2).
struct Emitter {
  float rain_mm_per_hour = 0.0f;
  DropSizes drop_sizes = DropSizes::marshall_palmer;
  float gamma_shape = 2.0f;  // mu of Ulbrich's gamma distribution; Marshall-Palmer is mu = 0
  float minimum_diameter_mm = 0.5f;
  float maximum_diameter_mm = 6.0f;
  float drawn_distance_m = 30.0f;  // drops farther than this become extinction and airlight
  std::int32_t maximum_drops =
      0;  // a budget: the distance shrinks until the drawn drops fit; 0: what the device affords
  std::uint32_t seed = 1;
};

// Mean wind plus sinusoidal gusts, whose integral is closed form, so that any frame stands alone.
struct Wind {
  glm::vec3 velocity_mps{0.0f};
  float gust_mps = 0.0f;  // amplitude added along the mean wind
  float gust_period_s = 7.0f;
  float swirl_mps = 0.0f;  // amplitude across the mean wind
};

// Homogeneous mist, besides the rain's own extinction.
struct Fog {
  float extinction_per_km = 1.0f;
  glm::vec3 albedo{0.96f};
};

// The night sky: a gradient of luminance, in cd/m2, with the city's glow above the horizon.
struct Sky {
  glm::vec3 zenith_cd_m2{0.004f, 0.006f, 0.012f};
  glm::vec3 horizon_cd_m2{0.05f, 0.04f, 0.03f};
  float glow_height = 0.25f;  // sine of the elevation at which the glow has fallen to 1/e
  float ambient = 1.0f;       // multiplies the sky's light on surfaces, not its picture
};

}  // namespace petrichor
