#pragma once
// What splashes throw up: secondary droplets and their cloud (physics, section 6).

#include <functional>
#include <glm/glm.hpp>

#include "systems/rain_frame.hpp"
#include "systems/splatter_frame.hpp"

namespace petrichor {

// The film of water that rain keeps on a hard surface; it decides what splashes (Cossali 1997: We Oh^-0.4 against
// 2100 + 5880 (h/D)^1.44, good for h/D of 0.1 to 1; below that as at 0.1).
constexpr double film_m = 1e-4;

struct Splash {
  double share;     // of such impacts that splash, 0 to 1: the threshold is a slope 40% wide, not a step
  double droplets;  // thrown up by one that does, 10 to 100; their water is at most a third of the drop's
};
Splash splash_of(double diameter_mm, double normal_speed_mps);

// Droplets of one impact, as a quadrature: weight sums to `droplets`. Diameters 0.05 to 0.25 of the drop's, even in
// their logarithm; speeds 1 to 0.1 of its normal speed, slower ones larger; 30 to 70 degrees above the surface.
struct Droplet {
  double diameter_mm, speed_mps, elevation_rad, weight;
};
// Mean of their squared diameters, in the drop's.
constexpr double crown_section = 0.0186;
constexpr int droplet_sizes = 6, droplet_elevations = 4;
void droplets_of(double diameter_mm, double normal_speed_mps, double droplets,
                 const std::function<void(const Droplet&)>&);

// Flies a droplet with drag in still air from the origin until it falls below a height (0: the surface it comes from):
// calls at(position, velocity) in the middle of each step, until that says false. y is up.
void fly(const glm::dvec3& velocity_mps, double diameter_mm, double step_s, double lowest_m,
         const std::function<bool(const glm::dvec3& position, const glm::dvec3& velocity)>& at);

// Sums over all classes. Millions of droplets of a downpour are a cloud whose density falls about exponentially with
// height; extinction and height are such that its column and its mean height are exact.
SplashMist splash_mist(const FrameRain&);

}  // namespace petrichor
