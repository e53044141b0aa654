#include "systems/rainfall/streaks/drop_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double surface_tension_n_m = 0.0728, water_kg_m3 = 998.0;
constexpr int orders = 11;

// Beard and Chuang 1987 (J. Atmos. Sci. 44, 1509): c_0 to c_10 times 10^4 for diameters of 1 to 6 mm, each half mm.
constexpr int rows = 11;
constexpr double beard_chuang[rows][orders] = {{-28, -30, -83, -22, -3, 2, 1, 0, 0, 0, 0},
                                               {-72, -70, -210, -57, -6, 7, 3, 0, -1, 0, 1},
                                               {-131, -120, -376, -96, -4, 15, 5, 0, -2, 0, 1},
                                               {-201, -172, -567, -137, 3, 29, 8, -2, -4, 0, 1},
                                               {-282, -230, -779, -175, 21, 46, 11, -6, -7, 0, 3},
                                               {-369, -285, -998, -207, 48, 68, 13, -13, -10, 0, 5},
                                               {-458, -335, -1211, -227, 83, 89, 12, -21, -13, 1, 8},
                                               {-549, -377, -1421, -240, 126, 110, 9, -31, -16, 4, 11},
                                               {-644, -416, -1629, -246, 176, 131, 2, -44, -18, 9, 14},
                                               {-742, -454, -1837, -244, 234, 150, -7, -58, -19, 15, 19},
                                               {-840, -480, -2034, -237, 297, 166, -21, -72, -19, 24, 22}};

std::array<double, orders> coefficients(double diameter_mm) {
  const double place = std::clamp((diameter_mm - 1.0) / 0.5, 0.0, double(rows - 1));
  const int row = std::min(static_cast<int>(place), rows - 2);
  // Flattening goes with the square of the diameter where it is small.
  const double small = diameter_mm < 1.0 ? diameter_mm * diameter_mm : 1.0, between = place - row;
  std::array<double, orders> c;
  for (int n = 0; n < orders; ++n)
    c[n] = 1e-4 * small * ((1.0 - between) * beard_chuang[row][n] + between * beard_chuang[row + 1][n]);
  return c;
}

}  // namespace

double oscillation_frequency_hz(int n, double diameter_mm) {
  const double a = 0.5e-3 * diameter_mm;
  return std::sqrt(n * (n - 1.0) * (n + 2.0) * surface_tension_n_m / (water_kg_m3 * a * a * a)) / (2.0 * pi);
}

DropShape sphere_shape() {
  DropShape shape;
  shape.polynomial[0] = 1.0;
  return shape;
}

DropShape drop_shape(double diameter_mm, const Oscillation& oscillation, double phase2, double phase3) {
  DropShape shape = sphere_shape();
  const std::array<double, orders> c = coefficients(diameter_mm);
  // cos(n theta) = T_n(x): T_{n+1} = 2 x T_n - T_{n-1}.
  std::array<double, orders> before{}, now{};
  before[0] = 1.0, now[1] = 1.0;
  shape.polynomial[0] += c[0];
  for (int n = 1; n < orders; ++n) {
    for (int k = 0; k < orders; ++k) shape.polynomial[k] += c[n] * now[k];
    std::array<double, orders> next{};
    for (int k = 0; k < orders; ++k) next[k] = (k > 0 ? 2.0 * now[k - 1] : 0.0) - before[k];
    before = now, now = next;
  }
  const double prolate = oscillation.prolate * std::sin(phase2);  // times P2 = 1.5 x^2 - 0.5
  shape.polynomial[0] -= 0.5 * prolate;
  shape.polynomial[2] += 1.5 * prolate;
  shape.sideways = oscillation.sideways * std::sin(phase3);
  shape.lean = {std::cos(oscillation.sideways_azimuth_rad), 0.0, std::sin(oscillation.sideways_azimuth_rad)};
  const double scale = std::cbrt(4.0 * pi / 3.0 / volume(shape));
  for (double& p : shape.polynomial) p *= scale;
  shape.sideways *= scale;
  return shape;
}

double radius(const DropShape& shape, const glm::dvec3& u) {
  const double x = -u.y;
  double r = 0.0;
  for (int k = orders - 1; k >= 0; --k) r = r * x + shape.polynomial[k];
  return r + shape.sideways * 1.5 * (5.0 * x * x - 1.0) * glm::dot(u, shape.lean);
}

double volume(const DropShape& shape) {
  // Integral of r^3 / 3 over all directions; r = A(x) + B(x) cos(phi), so round the vertical r^3 is
  // 2 pi (A^3 + 1.5 A B^2). Simpson's rule along x: the integrand is a polynomial of degree 33 at most.
  constexpr int steps = 512;
  double sum = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double x = -1.0 + 2.0 * i / steps;
    double a = 0.0;
    for (int k = orders - 1; k >= 0; --k) a = a * x + shape.polynomial[k];
    const double b = shape.sideways * 1.5 * (5.0 * x * x - 1.0) * std::sqrt(std::max(0.0, 1.0 - x * x));
    sum += (i == 0 || i == steps ? 1.0 : i % 2 ? 4.0 : 2.0) * a * (a * a + 1.5 * b * b);
  }
  return 2.0 * pi / 3.0 * sum * (2.0 / steps) / 3.0;
}

double surface(const DropShape& shape, const glm::dvec3& p, glm::dvec3& gradient) {
  const double distance = glm::length(p), inverse = 1.0 / distance;
  const glm::dvec3 u = p * inverse;
  const double x = -u.y;
  double r = 0.0, by_x = 0.0;
  for (int k = orders - 1; k >= 0; --k) {
    by_x = by_x * x + r;
    r = r * x + shape.polynomial[k];
  }
  const double along = glm::dot(u, shape.lean), wave = shape.sideways * 1.5 * (5.0 * x * x - 1.0);
  r += wave * along;
  by_x += shape.sideways * 15.0 * x * along;
  // u changes only across itself: the gradients of x and of dot(u, lean) are their vectors less what is along u.
  const glm::dvec3 across = by_x * (glm::dvec3(0.0, -1.0, 0.0) - x * u) + wave * (shape.lean - along * u);
  gradient = u - inverse * across;
  return distance - r;
}

}  // namespace petrichor
