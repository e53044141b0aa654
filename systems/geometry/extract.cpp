#include "systems/geometry/extract.hpp"

#include <cmath>
#include <cstring>

#include "components/light.hpp"
#include "components/transform.hpp"
#include "components/view.hpp"

namespace petrichor {
namespace {

// A running hash over 4-byte words (the finaliser of splitmix64 between them).
struct Hash {
  std::uint64_t state = 0x9e3779b97f4a7c15ull;
  void add(std::uint64_t word) {
    state = (state ^ word) * 0xbf58476d1ce4e5b9ull;
    state ^= state >> 29;
  }
  void add(float value) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    add(std::uint64_t{bits});
  }
  void add(const glm::vec3& v) { add(v.x), add(v.y), add(v.z); }
  void add(const glm::mat4& m) {
    std::uint64_t words[8];
    std::memcpy(words, &m, sizeof words);
    for (const std::uint64_t word : words) add(word);
  }
};

glm::quat rotation_of(const glm::mat4& m) {
  glm::vec3 x(m[0]), y(m[1]), z(m[2]);
  const float lx = glm::length(x), ly = glm::length(y), lz = glm::length(z);
  if (!(lx > 0.0f && ly > 0.0f && lz > 0.0f)) return {1.0f, 0.0f, 0.0f, 0.0f};
  x /= lx, y /= ly, z /= lz;
  if (glm::dot(glm::cross(x, y), z) < 0.0f) x = -x;  // a mirrored parent: keep up and view direction
  return glm::normalize(glm::quat_cast(glm::mat3(x, y, z)));
}

// Unit way the entity's -z points.
glm::vec3 forward_of(const glm::mat4& m) {
  const glm::vec3 z(m[2]);
  const float length = glm::length(z);
  return length > 0.0f && std::isfinite(length) ? -z / length : glm::vec3(0.0f, -1.0f, 0.0f);
}

}  // namespace

void track_cameras(Registry& registry) {
  registry.view<const Camera, const WorldTransform>().each(
      [&](Entity entity, const Camera&, const WorldTransform& world) {
        const glm::vec3 position(world.matrix[3]);
        const glm::quat orientation = rotation_of(world.matrix);
        if (CameraMotion* motion = registry.find<CameraMotion>(entity)) {
          motion->moving_known = glm::distance(motion->position_m, position) <= camera_jump_m;
          motion->previous_position_m = motion->moving_known ? motion->position_m : position;
          motion->previous_orientation = motion->moving_known ? motion->orientation : orientation;
          motion->position_m = position;
          motion->orientation = orientation;
        } else {
          registry.emplace<CameraMotion>(entity, position, orientation, position, orientation, false);
        }
      });
}

void extract_camera(const Registry& registry, Frame& frame, double interpolation, double step_s) {
  frame.uniforms.time.z = static_cast<float>(step_s);
  Entity chosen = null_entity;
  registry.view<Camera, WorldTransform>().each([&](Entity entity, const Camera& camera, const WorldTransform&) {
    if (camera.active && (chosen == null_entity || entity_index(entity) < entity_index(chosen))) chosen = entity;
  });
  if (chosen == null_entity) return;
  const auto& camera = registry.get<Camera>(chosen);
  const auto& world = registry.get<WorldTransform>(chosen);

  FrameCamera& out = frame.camera;
  out.position_m = glm::dvec3(glm::vec3(world.matrix[3]));
  out.orientation = rotation_of(world.matrix);
  out.velocity_mps = out.angular_velocity_radps = glm::vec3(0.0f);
  out.vertical_fov_rad = glm::radians(camera.vertical_fov_deg);
  out.near_m = camera.near_m;
  out.exposure_s = camera.exposure_s;
  out.exposure_ev100 = camera.exposure_ev100;
  out.bloom = camera.bloom;

  const auto* motion = registry.find<CameraMotion>(chosen);
  if (!motion || !motion->moving_known || !(step_s > 0.0)) return;
  const glm::dvec3 from(motion->previous_position_m), to(motion->position_m);
  out.position_m = glm::mix(from, to, interpolation);
  out.velocity_mps = glm::vec3((to - from) / step_s);
  out.orientation = glm::slerp(motion->previous_orientation, motion->orientation, static_cast<float>(interpolation));
  // The turn from one tick to the next about a world axis, the short way round.
  glm::dquat turn = glm::dquat(motion->orientation) * glm::conjugate(glm::dquat(motion->previous_orientation));
  if (turn.w < 0.0) turn = -turn;
  const glm::dvec3 axis(turn.x, turn.y, turn.z);
  const double sine = glm::length(axis);
  // Below a microradian a step it is the rounding of the matrices.
  if (sine > 1e-6) out.angular_velocity_radps = glm::vec3(axis / sine * (2.0 * std::atan2(sine, turn.w) / step_s));
}

void extract_instances(const Registry& registry, Frame& frame) {
  frame.instances.clear();
  Hash hash;
  registry.view<MeshInstance, WorldTransform>().each([&](Entity entity, const MeshInstance& mesh,
                                                         const WorldTransform& world) {
    frame.instances.push_back({mesh.model, mesh.mesh, mesh.casts_shadow, world.matrix, entity_index(entity)});
    hash.add((std::uint64_t{mesh.model} << 33) | (std::uint64_t{mesh.mesh} << 1) | (mesh.casts_shadow ? 1u : 0u));
    hash.add(world.matrix);
  });
  frame.geometry_version = hash.state;
}

void extract_lights(const Registry& registry, Frame& frame) {
  frame.lights.clear();
  Hash hash;
  registry.view<Light, WorldTransform>().each([&](const Light& light, const WorldTransform& world) {
    FrameLight out{};
    out.position_m = glm::vec3(world.matrix[3]);
    out.direction = forward_of(world.matrix);
    out.intensity = light.colour * light.intensity_cd;
    out.range_m = light.range_m;
    out.inner_cone_rad = glm::radians(light.inner_cone_deg);
    out.outer_cone_rad = glm::radians(light.outer_cone_deg);
    out.source_radius_m = light.source_radius_m;
    out.kind = light.kind == LightKind::spot          ? LIGHT_SPOT
               : light.kind == LightKind::directional ? LIGHT_DIRECTIONAL
                                                      : LIGHT_POINT;
    out.casts_shadow = light.casts_shadow;
    out.lights_rain = light.lights_rain;
    frame.lights.push_back(out);
    if (!light.casts_shadow) return;
    hash.add(std::uint64_t{frame.lights.size()});
    hash.add(out.position_m);
    hash.add(out.direction);
    hash.add(out.range_m);
    hash.add(out.outer_cone_rad);
    hash.add(out.source_radius_m);
    hash.add(static_cast<std::uint64_t>(out.kind));
  });
  frame.lights_version = hash.state;
}

}  // namespace petrichor
