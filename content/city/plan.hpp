#pragma once
// The plan of the town: Lamplighter Street along z, Weathercock Lane along x, crossing at the origin.

#include <glm/glm.hpp>

namespace petrichor::city {

inline constexpr float main_half_m = 5.0f;  // carriageway of the main street, |x|
inline constexpr float lane_half_m = 4.0f;  // carriageway of the cross street, |z|
inline constexpr float main_wall_m = 8.0f;  // building line of the main street
inline constexpr float lane_wall_m = 6.5f;  // building line of the cross street
inline constexpr float street_end_m = 60.0f;
inline constexpr float corner_cut_m = 3.0f;  // corner houses are cut at 45 degrees
inline constexpr float kerb_radius_m = 3.0f;
inline constexpr float gate_ground_m = 5.0f;  // ground floor of the gate house over the north end
inline constexpr float kerb_m = 0.12f;
inline constexpr float pavement_fall = 0.02f;  // pavements drain to the kerb

// Height of the carriageway: crown, tyre tracks, settled hollows. Metres, 0 at an ideal gutter.
float carriageway_height_m(float x, float z);

// Pavement surface at a distance from the kerb.
inline float pavement_height_m(float from_kerb_m) {
  return kerb_m + pavement_fall * from_kerb_m;
}

}  // namespace petrichor::city
