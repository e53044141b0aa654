#include "systems/drops/optics.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "systems/drops/drop_optics.hpp"
#include "systems/drops/rain_shared.h"

namespace petrichor {

glm::dvec3 sky_radiance(const FrameSky& sky, const glm::dvec3& direction) {
  const double glow = std::exp(-std::max(direction.y, 0.0) / std::max(double(sky.glow_height), 1e-3));
  return glm::mix(glm::dvec3(sky.zenith_cd_m2), glm::dvec3(sky.horizon_cd_m2), glow);
}

void bind_optics(ParticleOptics& optics, const Frame& frame, std::vector<float> (*make_phase)(),
                 std::array<glm::vec3, 4> (*make_ambient)(const FrameSky&)) {
  if (optics.phase.bytes == 0) upload(optics.phase, std::span<const float>(make_phase()));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RAIN_OPTICS_BINDING, optics.phase.id);
  const FrameSky& sky = frame.sky;
  const bool same = optics.known && sky.zenith_cd_m2 == optics.sky.zenith_cd_m2 &&
                    sky.horizon_cd_m2 == optics.sky.horizon_cd_m2 && sky.glow_height == optics.sky.glow_height;
  if (same) return;
  optics.ambient = make_ambient(sky);
  optics.sky = sky;
  optics.known = true;
}

void bind_rain_optics(RainOptics& optics, const Frame& frame) {
  static_assert(drop_phase_bins == RAIN_PHASE_BINS);
  bind_optics(optics, frame, make_drop_phase, [](const FrameSky& sky) {
    return fit_drop_radiance([&](const glm::dvec3& d) { return sky_radiance(sky, d); });
  });
}

void set_ambient(const ParticleOptics& optics, const Program& program) {
  for (int i = 0; i < 4; ++i) program.set("ambient[" + std::to_string(i) + "]", optics.ambient[i]);
}

}  // namespace petrichor
