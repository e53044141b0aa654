#pragma once
// The streak table (after Garg and Nayar 2006, the drops traced here): how bright an oscillating drop is along and
// across its streak, by where the eye and a distant lamp stand.
//
// Angles, radians: of the eye and of the lamp above the drop's horizon, and between their bearings as seen from the
// drop, 0 to pi (0: the lamp stands on the eye's side; pi: the drop stands before it). Beyond pi it is the mirror
// image. Along: cycles of the drop's oscillation (2,0), which repeats every V / f2 metres of fall; its frequency and
// the fall speed say how many a streak holds. Oscillation: by how many cycles mode (3,1) is ahead of twice mode (2,0),
// 0 to 1; f3 is 1.936 f2, so over one cycle along it changes by -0.064. Both repeat.
//
// Radiance per irradiance, 1/sr = phase(turn) * mean(angles) * modulation(angles, along, oscillation) *
// profile(angles, across). The phase function is that of make_drop_phase(), but of these drops, over all phases and all
// views: so only what differs from it is interpolated, the mean by its logarithm, for it varies by factors. Modulation
// and profile have mean 1, the profile weighted by the disc's chord.

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace petrichor {

// Nodes from end to end: of the view's elevation over -90 to 90 degrees, the lamp's over -90 to 90, the azimuth over 0
// to 180.
struct StreakGrid {
  int view = 7, light = 9, azimuth = 9;
  int entries() const { return view * light * azimuth; }
};

struct StreakDrop {
  double diameter_mm = 2.0;
  double prolate = 0.1, sideways = 0.05;  // amplitudes A20 and A31, in radii
  double lean_deg = 45.0;                 // of mode (3,1), from the bearing of the eye
  double exposure_s = 1.0 / 60.0;         // that the table is described for: how many bands its streak holds
};

struct StreakTable {
  StreakGrid grid;
  StreakDrop drop;
  int along = 16, oscillations = 8, across = 8;
  int rays = 0;  // traced for each view and shape
  // Entry (view * light nodes + light) * azimuth nodes + azimuth.
  std::vector<float> modulation;  // entries x oscillations x along
  std::vector<float> profile;     // entries x across: from the side away from the lamp to the lamp's side
  std::vector<float> mean;        // entries
  std::vector<float> phase;       // drop_phase_bins, as make_drop_phase()
};

struct StreakAngles {
  double view_elevation, light_elevation, azimuth;
};
// Unit vectors from the drop.
StreakAngles streak_angles(const glm::dvec3& to_eye, const glm::dvec3& to_lamp);
double turn_cosine(const StreakAngles&);  // 1 where the drop stands before the lamp

// As the shaders read it. nearest_four: as Tariq 2007, no view elevation (0), mirrored light elevation, straight lines
// between the four nearest entries.
double streak_modulation(const StreakTable&, const StreakAngles&, double along, double oscillation,
                         bool nearest_four = false);
double streak_phase(const StreakTable&, const StreakAngles&, bool nearest_four = false);  // phase * mean, 1/sr
double streak_profile(const StreakTable&, const StreakAngles&, double across, bool nearest_four = false);

// OpenEXR through OpenImageIO, images of floats, a row an entry: "modulation" (oscillations x along wide), "profile"
// (across wide) and "mean" (one wide), with the angles, the drop and the amplitudes as attributes; and "phase", one row
// of drop_phase_bins. Written
// beside and renamed; errors name the file and say what to do.
Result<void> write_streak_table(const std::string& file, const StreakTable&);
Result<StreakTable> load_streak_table(const std::string& file);

}  // namespace petrichor
