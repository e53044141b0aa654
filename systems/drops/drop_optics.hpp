#pragma once
// How a drop shows light: geometric optics of a water sphere (a drop is some 1000 wavelengths wide).

#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

constexpr double water_refractive_index = 1.333;

// Shares of light that a water surface reflects, by polarisation across and within the plane of incidence.
// The same from either side; the cosine is that of the angle in air.
struct Fresnel {
  double across, within;
};
Fresnel fresnel(double cosine_in_air);

// What leaves a ray that hits the sphere at `offset` (0 at the axis, 1 at the rim): one entry per order,
// 0 the outer reflection, 1 straight through, 2 one internal reflection, ... `turn_rad` is the deviation from
// the incoming direction, 0 to pi; `share` the power.
struct DropRay {
  double turn_rad, share;
};
constexpr int drop_ray_orders = 5;
std::array<DropRay, drop_ray_orders> trace_sphere(double offset);

// Radiance of the drop's disc per irradiance on it, 1/sr, averaged over the disc, for light that turns by
// `turn`: 0 looks at a lamp through the drop. Integrates over the sphere to the power of the orders traced.
// Entry i is the mean over the bin sin(turn/2) in [i, i+1)/size, so that the forward lobe has the finest bins.
constexpr int drop_phase_bins = 256;
std::vector<float> make_drop_phase();

// Mean radiance of the disc of a drop seen along a unit direction (from the eye), in surroundings at infinity
// given by their radiance: what the eye sees reflected and refracted in it. Upright surroundings are seen inverted.
glm::dvec3 drop_radiance(const glm::dvec3& direction,
                         const std::function<glm::dvec3(const glm::dvec3& direction)>& surroundings);

// The same in surroundings that depend on the elevation alone, as a cubic in the sine of the view's elevation
// (least squares): a drop gathers from so wide a lobe that what it shows changes slowly.
std::array<glm::vec3, 4> fit_drop_radiance(const std::function<glm::dvec3(const glm::dvec3& direction)>& surroundings);
// Of anything that is seen along a unit direction and depends on its elevation alone.
std::array<glm::vec3, 4> fit_by_elevation(const std::function<glm::dvec3(const glm::dvec3& direction)>& seen_along);

}  // namespace petrichor
