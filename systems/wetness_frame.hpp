#pragma once
// How wet the world is in one frame. Filled by systems/wetness; absent where nothing has been wet and it does not rain.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "components/weather.hpp"
#include "systems/rain_frame.hpp"

namespace petrichor {

// Films by how much of the open ground's rain a surface gets (its exposure), for a few porosities and slopes; between
// them linear. Exposures are those along the fall of the rain that wets now, and along one remembered fall.
constexpr int film_exposures = 24;       // most_exposure (i / (n - 1))^3: a steady film is linear in i
constexpr int film_porosities = 4;       // 0, 1/3, 2/3, 1
constexpr int remembered_exposures = 6;  // likewise, where a fall is remembered; else 1
constexpr float most_exposure = 4.0f;
constexpr std::array<float, 3> film_slopes{0.02f, 0.1414f, 1.0f};  // sines; the log between them is even

struct FrameWetness {
  float rain_mm_per_hour = 0.0f;  // that falls now
  float film_mm = 0.0f;           // on open level ground of porosity 1/3
  float soaked = 0.0f;            // its pores, 0 to 1
  bool published = false;
  // [porosity][remembered][exposure]: mm of film at the three slopes, filling of the pores 0 to 1.
  std::vector<glm::vec4> films;
  int remembered = 1;  // exposures of the remembered fall: 1 or remembered_exposures
  // Metres that a film of open ground has flown since the start: down a street's slope, down a wall.
  glm::dvec2 flown_m{0.0};

  // The rain that wetted, for maps of shelter when none falls: its classes and velocities, in the wind of then.
  std::optional<FrameRain> rain;
  std::optional<Wind> wind;
  // Level metres per metre of fall: spread along the mean wind of what falls about the mean (classes and gusts).
  float tilt_spread = 0.0f;
  // Where remembered > 1: the fall from which the map of remembered shelter is seen.
  glm::vec3 remembered_fall_mps{0.0f, -1.0f, 0.0f};
};

}  // namespace petrichor
