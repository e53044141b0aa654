#pragma once
// Baked sequences: crowns of splashes for the shells, and the mist that fins carry. Made by this project, of models.

#include <cstdint>
#include <vector>

namespace petrichor {

// A crown at an age (in D / V): radius of its sheet at a height z (all in D), and the height of its rim.
// Yarin and Weiss 1995 (radius (2/3)^(1/4) (h/D)^(-1/4) sqrt(V t / D)) until it reaches the largest spread, 5.8 D.
double crown_radius(double age, double height);
double crown_rim(double age);
// How thick the sheet stands at a share of its life, height and radius (D), up to a factor that makes its whole right;
// its rim is as blurred as that many D.
double crown_sheet(double share_of_life, double height, double radius, double blur);
// How much of it is left: it fades at the end of its life.
double crown_left(double share_of_life);

// SPLATTER_SHELLS layers of SPLATTER_AGES rows of SPLATTER_RADII floats: the opacity per diameter of height of a drop's
// crown in a layer, integrated over its age as a share of its life. Radius in SPLATTER_REACH D, height in
// SPLATTER_HEIGHT D. Over all the layers and the plane the opacity is pi/4 D^2 at each age: as if all that the drop
// throws up had the cross-section of the drop; who draws multiplies.
std::vector<float> make_crowns();

// Density of mist on a fin, side x side texels, two channels, 8 bit, tiling: mean 128, deviation mist_deviation * 255.
constexpr int mist_texels = 256;
constexpr double mist_deviation = 0.17;
std::vector<std::uint8_t> make_mist_texture();

}  // namespace petrichor
