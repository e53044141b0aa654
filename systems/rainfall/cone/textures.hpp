#pragma once
// The cone's textures (Wang and Wade 2004: "four artist-generated textures"), made here from the sizes of drops or
// flakes instead of by an artist: four tiles each, one per layer of the cone, all tileable.

#include <array>
#include <cstdint>
#include <future>
#include <vector>

#include "components/techniques.hpp"
#include "systems/cone_frame.hpp"

namespace petrichor {

constexpr int cone_texture_size = 512;  // texels; across: azimuth, up: along the axis
constexpr int cone_texture_levels = 7;  // of detail, down to 8 texels
constexpr int cone_channels = 4;        // each four times as many streaks as the one before, and those among them
constexpr double cone_texture_exposure_s = 1.0 / 60.0;  // streaks are as long as their fall in this time

// How a layer's tile lies on the cone. A tile spans 2 pi / tiles_around of azimuth and tile_m along the axis.
struct ConeLayer {
  double from_m, to_m;  // the shell that it stands for
  double radius_m;      // of the cone where it is widest; harmonic mean over the shell, so angular speeds are its mean
  int tiles_around;
  double tile_m;
};
const std::array<ConeLayer, cone_layers>& cone_layout(bool flakes);

// What a tile is made of: drops by diameter, flakes by the diameter that they melt to, mm.
struct ConeParticle {
  double width_mm, area_mm2;  // of its image at rest
  double speed_mps;
};
struct ConeParticles {
  double smallest_mm, largest_mm;
  double (*density)(double mm);  // relative number per mm
  ConeParticle (*particle)(double mm);
  double full_per_m3;  // of the last channel
  bool flakes;
};
const ConeParticles& cone_particles(ConeTexture);  // automatic: rain
// Of a texture's particles, weighted by extinction: a streak of 1 is this speed times cone_texture_exposure_s long, and
// the width.
struct ConeMeans {
  double speed_mps, width_m;
};
ConeMeans cone_means(ConeTexture);

// One tile: 8-bit opacity up to a factor, so that what is laid over the picture is opacity / mean * wanted. Levels of
// detail are box filtered and rounded at random, so their means agree to a thousandth; mean[level] is exact.
struct ConeTile {
  std::vector<std::vector<std::uint8_t>> levels;       // 4 channels a texel, row 0 at v = 0
  std::vector<std::array<float, cone_channels>> mean;  // of each level, 0 to 255
};
struct ConeTextureSet {
  std::array<ConeTile, cone_layers> tiles;
  double full_per_m3 = 0.0;
};
// Pure function of its arguments; some 0.15 s.
ConeTextureSet make_cone_textures(ConeTexture, std::uint32_t seed = 1);
// The same, made once, in a thread of its own that the first call starts: ask when it begins to rain, wait when it is
// drawn. From any thread.
std::shared_future<ConeTextureSet> shared_cone_textures(ConeTexture);

}  // namespace petrichor
