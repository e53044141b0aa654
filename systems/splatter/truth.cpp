#include "systems/splatter/truth.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/random.hpp"
#include "systems/drops/drop_optics.hpp"
#include "systems/drops/drop_physics.hpp"
#include "systems/splatter/mist.hpp"

namespace petrichor {
namespace {

constexpr double pi = 3.14159265358979;
constexpr double step_s = 2e-3;

struct Eye {
  glm::dvec3 place;
  glm::dmat3 turn;  // world -> view
  double focal_px;
};

}  // namespace

void fly_mist(const CatcherShape& shape, const FrameRain& rain, const FrameLight& lamp, int width, int height,
              int droplets, std::uint32_t seed, const std::vector<std::vector<float>>& hidden,
              std::vector<MistView>& views) {
  const ScaledShape scaled{&shape, glm::vec3(1.0f)};
  static const std::vector<float> phase = make_drop_phase();
  std::vector<double> areas, strikes;  // summed up: level area of faces; drops on a level square metre a second
  std::vector<std::size_t> faces;
  double area = 0.0, flux = 0.0;
  for (std::size_t i = 0; i + 2 < shape.indices.size(); i += 3) {
    const glm::vec3 &a = shape.positions[shape.indices[i]], &b = shape.positions[shape.indices[i + 1]],
                    &c = shape.positions[shape.indices[i + 2]];
    const double level = 0.5 * glm::cross(b - a, c - a).y;
    if (!(level > 0.0)) continue;
    area += level;
    areas.push_back(area);
    faces.push_back(i);
  }
  for (const RainClass& c : rain.classes) strikes.push_back(flux += double(c.drops_per_m3) * c.fall_speed_mps);
  std::vector<Eye> eyes;
  for (MistView& v : views) {
    v.light.assign(std::size_t(width) * std::size_t(height), 0.0);
    v.depth = v.light;
    eyes.push_back({v.camera.position_m, glm::transpose(glm::dmat3(glm::mat3_cast(v.camera.orientation))),
                    0.5 * height / std::tan(0.5 * double(v.camera.vertical_fov_rad))});
  }
  const auto pick = [](const std::vector<double>& sums, double u) {
    const auto at = std::upper_bound(sums.begin(), sums.end(), u * sums.back());
    return std::min(static_cast<std::size_t>(at - sums.begin()), sums.size() - 1);
  };
  RandomStream random(seed, 0x3157);
  for (int n = 0; n < droplets; ++n) {
    const std::size_t f = faces[pick(areas, random.uniform())];
    const RainClass& drop = rain.classes[pick(strikes, random.uniform())];
    float u = random.uniform(), v = random.uniform();
    if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
    const glm::vec3 &a = shape.positions[shape.indices[f]], &b = shape.positions[shape.indices[f + 1]],
                    &c = shape.positions[shape.indices[f + 2]];
    const glm::dvec3 from = glm::dvec3(a + u * (b - a) + v * (c - a));
    const glm::dvec3 normal = glm::normalize(glm::dvec3(glm::cross(b - a, c - a)));
    const double size_pick = random.uniform(), turn = 2.0 * pi * random.uniform();
    // What a higher surface catches does not strike here.
    if (surface_at(scaled, float(from.x), float(from.z)).x > from.y + 0.03) continue;
    const double normal_speed = drop.fall_speed_mps * normal.y;
    const Splash splash = splash_of(drop.diameter_mm, normal_speed);
    if (!(splash.share > 0.0)) continue;
    Droplet chosen{};
    int number = 0;
    const int wanted =
        std::min(int(size_pick * droplet_sizes * droplet_elevations), droplet_sizes * droplet_elevations - 1);
    droplets_of(drop.diameter_mm, normal_speed, splash.droplets, [&](const Droplet& d) {
      if (number++ == wanted) chosen = d;
    });
    // All that one sample stands for: impacts a second, that splash, times droplets.
    const double a_second = area * flux / droplets * splash.share * splash.droplets;
    const double section = a_second * 0.25 * pi * chosen.diameter_mm * chosen.diameter_mm * 1e-6 * step_s;
    const glm::dvec3 side =
        glm::normalize(glm::cross(std::abs(normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), normal));
    const glm::dvec3 across = glm::cross(normal, side);
    const glm::dvec3 out = std::cos(chosen.elevation_rad) * (std::cos(turn) * side + std::sin(turn) * across) +
                           std::sin(chosen.elevation_rad) * normal;
    fly(out * chosen.speed_mps, chosen.diameter_mm, step_s, -0.6,
        [&](const glm::dvec3& offset, const glm::dvec3& velocity) {
          const glm::dvec3 p = from + offset;
          const bool inside =
              p.x > shape.low_m.x && p.x < shape.high_m.x && p.z > shape.low_m.z && p.z < shape.high_m.z;
          if (inside && velocity.y < 0.0) {
            const glm::vec3 below = surface_at(scaled, float(p.x), float(p.z));
            if (below.y > 0.5f && p.y < below.x) return false;
          }
          const glm::dvec3 from_lamp = p - glm::dvec3(lamp.position_m);
          const double square = glm::dot(from_lamp, from_lamp);
          for (std::size_t i = 0; i < views.size(); ++i) {
            const glm::dvec3 to = p - eyes[i].place;
            const glm::dvec3 seen = eyes[i].turn * to;
            if (seen.z > -0.05) continue;
            const int x = int(std::floor(0.5 * width + eyes[i].focal_px * seen.x / -seen.z));
            const int y = int(std::floor(0.5 * height + eyes[i].focal_px * seen.y / -seen.z));
            if (x < 0 || y < 0 || x >= width || y >= height) continue;
            const auto at = std::size_t(y) * std::size_t(width) + std::size_t(x);
            if (-seen.z > hidden[i][at]) continue;
            const double distance2 = glm::dot(to, to), cosine = -seen.z / std::sqrt(distance2);
            const double pixel_sr = cosine * cosine * cosine / (eyes[i].focal_px * eyes[i].focal_px);
            const double depth = section / (distance2 * pixel_sr);
            const double turned = glm::dot(from_lamp, -to) / std::sqrt(square * distance2);
            const auto bin = std::min(std::size_t(std::sqrt(std::max(0.5 - 0.5 * turned, 0.0)) * drop_phase_bins),
                                      std::size_t{drop_phase_bins - 1});
            views[i].depth[at] += depth;
            views[i].light[at] += depth * lamp.intensity.x / square * phase[bin];
          }
          return true;
        });
  }
}

}  // namespace petrichor
