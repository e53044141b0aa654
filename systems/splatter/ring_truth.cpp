#include "systems/splatter/ring_truth.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/random.hpp"
#include "systems/drops/drop_optics.hpp"
#include "systems/splatter/crowns.hpp"

namespace petrichor {
namespace {

constexpr double pi = 3.14159265358979, sharp = 0.05;  // of the rim, D
constexpr int life_steps = 512;

// What a crown's sheet is multiplied by at a share of its life, so that its whole is pi/4 D^2 of what is left.
const std::vector<double>& scales() {
  static const std::vector<double> all = [] {
    std::vector<double> found;
    constexpr int heights = 60, radii = 150;
    for (int i = 0; i < life_steps; ++i) {
      const double share = (i + 0.5) / life_steps;
      double sum = 0.0;
      for (int j = 0; j < heights; ++j)
        for (int k = 0; k < radii; ++k) {
          const double r = (k + 0.5) * SPLATTER_REACH / radii;
          sum += crown_sheet(share, (j + 0.5) * SPLATTER_HEIGHT / heights, r, sharp) * 2.0 * pi * r;
        }
      sum *= SPLATTER_REACH / radii * SPLATTER_HEIGHT / heights;
      found.push_back(sum > 1e-9 ? 0.25 * pi * crown_left(share) / sum : 0.0);
    }
    return found;
  }();
  return all;
}

struct Impact {
  glm::dvec3 from_middle;  // of the place, along the surface, m
  double diameter_m, from_s, to_s;
};

// Those whose cells hold a place, of the last three slots: rings.glsl says how they are strewn.
template <class Each>
void impacts_at(const Frame& frame, const CatcherGpu& c, const glm::dvec3& place, const glm::dvec3& normal,
                double struck, double slot_s, const Each& each) {
  const glm::dvec3 facing = glm::abs(normal);
  const unsigned axis = facing.y >= 0.55 ? 1u : facing.x > facing.z ? 0u : 2u;
  const auto plane = [&](const glm::dvec3& v) {
    return axis == 1u ? glm::dvec2(v.x, v.z) : axis == 0u ? glm::dvec2(v.y, v.z) : glm::dvec2(v.x, v.y);
  };
  const double margin = c.shells.y, cell_m = 2.5 * (1.45 * double(c.crown.y) * SPLATTER_REACH + margin);
  const double expected = c.crown.x / std::max({facing.x, facing.y, facing.z}) * cell_m * cell_m * slot_s;
  const double slot = std::floor(frame.time_s / slot_s), in_slot = frame.time_s - slot * slot_s;
  const double window = std::clamp(double(frame.camera.exposure_s), 1e-3, slot_s);
  for (int i = 0; i < 3; ++i) {
    const auto when = static_cast<std::uint32_t>(static_cast<std::int64_t>(slot)) - static_cast<std::uint32_t>(i);
    const glm::dvec2 shift(glm::vec2(random_float4(glm::uvec4(when, 0x5917u, frame.rain->seed, 0u))));
    const glm::dvec2 at = plane(place) / cell_m + shift, cell = glm::floor(at);
    const glm::uvec4 bits = random_bits4({static_cast<std::uint32_t>(static_cast<std::int32_t>(cell.x)),
                                          static_cast<std::uint32_t>(static_cast<std::int32_t>(cell.y)),
                                          when * 4u + axis, c.key.x ^ (c.key.y << 8u)});
    if (unit_float(bits.x) >= expected * struck) continue;
    const double diameter = c.crown.y * (0.55 + 0.9 * unit_float(bits.y));
    const double to = in_slot - (unit_float(bits.w) - double(i)) * slot_s, from = std::max(to - window, 0.0);
    if (to <= 0.0 || from >= diameter / c.crown.z * SPLATTER_LIFE) continue;
    const double reach = diameter * SPLATTER_REACH;
    const glm::dvec2 room = glm::dvec2(bits.z & 0xffffu, bits.z >> 16u) / 65536.0;
    const glm::dvec2 away =
        (at - cell) * cell_m - glm::mix(glm::dvec2(reach + margin), glm::dvec2(cell_m - reach - margin), room);
    const double up = axis == 1u ? normal.y : axis == 0u ? normal.x : normal.z;
    const double rise = -glm::dot(plane(normal) / up, away);
    each(Impact{axis == 1u   ? glm::dvec3(away.x, rise, away.y)
                : axis == 0u ? glm::dvec3(rise, away.x, away.y)
                             : glm::dvec3(away.x, away.y, rise),
                diameter, from, to});
  }
}

}  // namespace

std::vector<double> draw_rings(const Frame& frame, const CatcherGpu& c, const FrameLight& lamp, int width, int height,
                               const std::vector<float>& distances_m, const std::vector<glm::vec3>& normals,
                               double slot_s, int heights, int moments) {
  static const std::vector<float> phase = make_drop_phase();
  const double focal = 0.5 * height / std::tan(0.5 * double(frame.camera.vertical_fov_rad));
  const glm::dmat3 turn(glm::mat3_cast(frame.camera.orientation));
  const glm::dmat4 local(c.local_from_relative);
  const double window = std::clamp(double(frame.camera.exposure_s), 1e-3, slot_s);
  std::vector<double> light(distances_m.size(), 0.0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = std::size_t(y) * std::size_t(width) + std::size_t(x);
      if (!std::isfinite(distances_m[at])) continue;
      const glm::dvec3 relative = turn * (double(distances_m[at]) * glm::dvec3((x + 0.5 - 0.5 * width) / focal,
                                                                               (y + 0.5 - 0.5 * height) / focal, -1.0));
      const glm::dvec3 world_normal(normals[at]), view = -glm::normalize(relative);
      const double facing = glm::dot(world_normal, view), struck = std::max(world_normal.y, 0.0);
      if (facing <= 0.02 || struck <= 0.0) continue;
      const glm::dvec3 place(local * glm::dvec4(relative, 1.0)), normal = glm::dmat3(local) * world_normal;
      const glm::dvec3 slide = glm::dmat3(local) * view / facing - normal;
      double depth = 0.0;
      impacts_at(frame, c, place, normal, struck, slot_s, [&](const Impact& i) {
        const double life = i.diameter_m / c.crown.z * SPLATTER_LIFE, tall = i.diameter_m * SPLATTER_HEIGHT;
        const double wide = i.diameter_m * SPLATTER_REACH + tall * glm::length(slide);
        if (glm::dot(i.from_middle, i.from_middle) > wide * wide) return;
        double sum = 0.0;
        for (int k = 0; k < heights; ++k) {
          const double h = (k + 0.5) / heights * tall;
          const double r = glm::length(i.from_middle + slide * h) / i.diameter_m;
          if (r >= SPLATTER_REACH) continue;
          for (int m = 0; m < moments; ++m) {
            const double share = (i.from_s + (m + 0.5) / moments * (i.to_s - i.from_s)) / life;
            if (share >= 1.0) break;
            sum +=
                scales()[static_cast<std::size_t>(share * life_steps)] * crown_sheet(share, h / i.diameter_m, r, sharp);
          }
        }
        depth += sum * SPLATTER_HEIGHT / heights / moments * (i.to_s - i.from_s) / window / facing;
      });
      if (!(depth > 0.0)) continue;
      const glm::dvec3 from_lamp = relative + frame.camera.position_m - glm::dvec3(lamp.position_m);
      const double square = glm::dot(from_lamp, from_lamp), turned = glm::dot(from_lamp, view) / std::sqrt(square);
      const auto bin = std::min(std::size_t(std::sqrt(std::max(0.5 - 0.5 * turned, 0.0)) * drop_phase_bins),
                                std::size_t{drop_phase_bins - 1});
      light[at] = (1.0 - std::exp(-depth * c.shells.z)) * lamp.intensity.x / square * phase[bin];
    }
  return light;
}

}  // namespace petrichor
