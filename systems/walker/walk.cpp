#include "systems/walker/walk.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "systems/walker/collision.hpp"

namespace petrichor {
namespace {

constexpr float gravity_mps2 = 9.81f;
constexpr float highest_step_m = 0.4f;  // kerbs and stairs are climbed, walls are not
constexpr float jump_mps = 3.2f;        // half a metre high
constexpr float fastest_fall_mps = 55.0f;
constexpr float steepest_floor_cos = 0.6f;  // 53 degrees
constexpr float world_bottom_m = -200.0f;

glm::quat head(const Walker& walker) {
  return glm::angleAxis(glm::radians(-walker.yaw_deg), glm::vec3(0, 1, 0)) *
         glm::angleAxis(glm::radians(walker.pitch_deg), glm::vec3(1, 0, 0));
}

glm::vec3 wanted_direction(const PlayerInput& input, const glm::quat& facing) {
  glm::vec3 along(static_cast<float>(input.right) - static_cast<float>(input.left), 0.0f,
                  static_cast<float>(input.back) - static_cast<float>(input.forward));
  if (along == glm::vec3(0.0f)) return along;
  return facing * glm::normalize(along);
}

// How far the body may go along a level unit direction before it touches something, and what it touches: rays
// at shin, waist and head height, through its middle and both its sides.
std::optional<RayHit> touch(const CollisionScene& scene, const Walker& walker, const glm::vec3& feet_m,
                            const glm::vec3& direction, float reach_m) {
  const glm::vec3 side(-direction.z, 0.0f, direction.x);
  std::optional<RayHit> nearest;
  for (const float height_m : {highest_step_m + 0.05f, 0.5f * walker.eye_height_m, walker.eye_height_m})
    for (const float across : {-0.9f, -0.45f, 0.0f, 0.45f, 0.9f}) {
      const glm::vec3 from = feet_m + glm::vec3(0, height_m, 0) + side * (across * walker.radius_m);
      const auto hit = scene.cast(from, direction, reach_m + walker.radius_m);
      // A body is round: its side stands back from its front.
      const float front_m = walker.radius_m * std::sqrt(1.0f - across * across);
      if (hit && (!nearest || hit->distance_m - front_m < nearest->distance_m))
        nearest = RayHit{hit->distance_m - front_m, hit->normal};
    }
  if (nearest && nearest->distance_m > reach_m) nearest.reset();
  return nearest;
}

glm::vec3 move_level(const CollisionScene& scene, const Walker& walker, glm::vec3 feet_m, glm::vec3 move_m) {
  constexpr float skin_m = 0.005f;
  for (int slide = 0; slide < 3; ++slide) {
    const float length_m = glm::length(move_m);
    if (length_m < 1e-6f) break;
    const glm::vec3 direction = move_m / length_m;
    const auto hit = touch(scene, walker, feet_m, direction, length_m + skin_m);
    if (!hit) return feet_m + move_m;
    const float free_m = std::clamp(hit->distance_m - skin_m, 0.0f, length_m);
    feet_m += direction * free_m;
    // The rest of the way goes along the wall.
    glm::vec3 wall(hit->normal.x, 0.0f, hit->normal.z);
    if (glm::length(wall) < 1e-3f) break;
    wall = glm::normalize(wall);
    move_m = direction * (length_m - free_m);
    move_m -= wall * std::min(glm::dot(move_m, wall), 0.0f);
    move_m.y = 0.0f;
  }
  return feet_m;
}

// Squeezed against something, the body gives way.
glm::vec3 push_out(const CollisionScene& scene, const Walker& walker, glm::vec3 feet_m) {
  for (const float height_m : {highest_step_m + 0.05f, walker.eye_height_m})
    for (int i = 0; i < 8; ++i) {
      const float angle = static_cast<float>(i) * glm::quarter_pi<float>();
      const glm::vec3 direction(std::cos(angle), 0.0f, std::sin(angle));
      const auto hit = scene.cast(feet_m + glm::vec3(0, height_m, 0), direction, walker.radius_m);
      if (hit) feet_m -= direction * (walker.radius_m - hit->distance_m);
    }
  return feet_m;
}

// Height of the floor under the feet, looking from a step above them.
std::optional<float> floor_under(const CollisionScene& scene, const Walker& walker, const glm::vec3& feet_m,
                                 float down_m) {
  std::optional<float> highest_m;
  const float r = 0.5f * walker.radius_m;
  for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(r, 0), glm::vec2(-r, 0), glm::vec2(0, r), glm::vec2(0, -r)}) {
    const glm::vec3 from = feet_m + glm::vec3(at.x, highest_step_m, at.y);
    const auto hit = scene.cast(from, glm::vec3(0, -1, 0), highest_step_m + down_m);
    if (hit && hit->normal.y >= steepest_floor_cos)
      highest_m = std::max(highest_m.value_or(-1e30f), from.y - hit->distance_m);
  }
  return highest_m;
}

}  // namespace

void step_walker(Walker& walker, Transform& eye, const PlayerInput& input, const CollisionScene* scene, double step_s) {
  const auto dt = static_cast<float>(step_s);
  walker.yaw_deg = std::remainder(walker.yaw_deg + input.turn_right_deg, 360.0f);
  walker.pitch_deg = std::clamp(walker.pitch_deg + input.turn_up_deg, -89.0f, 89.0f);
  eye.orientation = head(walker);
  if (input.toggle_flying) {
    walker.flying = !walker.flying;
    walker.velocity_mps = glm::vec3(0.0f);
  }

  if (walker.flying || !scene) {
    glm::vec3 way = wanted_direction(input, eye.orientation);
    way.y += static_cast<float>(input.up) - static_cast<float>(input.down);
    walker.velocity_mps = way * walker.fly_mps * (input.run ? 3.0f : 1.0f);
    eye.position_m += walker.velocity_mps * dt;
    return;
  }

  const glm::quat level = glm::angleAxis(glm::radians(-walker.yaw_deg), glm::vec3(0, 1, 0));
  const glm::vec3 wanted = wanted_direction(input, level) * (input.run ? walker.run_mps : walker.walk_mps);
  // People reach their pace within a few tenths of a second, and steer little in the air.
  const float response_s = walker.on_ground ? 0.08f : 0.6f;
  const float blend = 1.0f - std::exp(-dt / response_s);
  walker.velocity_mps.x += (wanted.x - walker.velocity_mps.x) * blend;
  walker.velocity_mps.z += (wanted.z - walker.velocity_mps.z) * blend;
  if (walker.on_ground && input.up) {
    walker.velocity_mps.y = jump_mps;
    walker.on_ground = false;
  }

  const glm::vec3 feet_before = eye.position_m - glm::vec3(0, walker.eye_height_m, 0);
  glm::vec3 feet =
      move_level(*scene, walker, feet_before, glm::vec3(walker.velocity_mps.x, 0.0f, walker.velocity_mps.z) * dt);
  feet = push_out(*scene, walker, feet);

  const bool rising = walker.velocity_mps.y > 0.0f;
  if (!walker.on_ground) walker.velocity_mps.y = std::max(walker.velocity_mps.y - gravity_mps2 * dt, -fastest_fall_mps);
  const float fall_m = walker.on_ground ? 0.0f : -walker.velocity_mps.y * dt;
  const float search_m = walker.on_ground ? highest_step_m : std::max(fall_m, 0.0f);
  const auto floor_m = rising ? std::nullopt : floor_under(*scene, walker, feet, search_m + 1e-3f);
  if (floor_m && (walker.on_ground || feet.y - fall_m <= *floor_m)) {
    feet.y = *floor_m;
    walker.velocity_mps.y = 0.0f;
    walker.on_ground = true;
  } else {
    walker.on_ground = false;
    if (rising && scene->cast(feet + glm::vec3(0, walker.eye_height_m, 0), glm::vec3(0, 1, 0), 0.15f - fall_m))
      walker.velocity_mps.y = 0.0f;
    else
      feet.y -= fall_m;
  }
  // Outside every floor there is nothing to fall on: stop and let the person fly back.
  if (feet.y < world_bottom_m) {
    walker.flying = true;
    walker.velocity_mps = glm::vec3(0.0f);
  }

  eye.position_m = feet + glm::vec3(0, walker.eye_height_m, 0);
}

void walk(SystemContext& context) {
  context.registry.view<Walker, Transform>().each([&](Entity, Walker& walker, Transform& eye) {
    step_walker(walker, eye, context.input, context.collision, context.step_s);
  });
}

}  // namespace petrichor
