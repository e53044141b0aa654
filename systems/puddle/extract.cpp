#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "components/transform.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/frustum.hpp"
#include "systems/puddle/puddle.hpp"
#include "systems/puddle/puddle_shared.h"
#include "systems/puddle/water.hpp"
#include "systems/puddle_frame.hpp"

namespace petrichor {

void extract_puddles(const Registry& registry, Frame& frame) {
  const float none = frame.techniques.share(Effect::puddles, PuddleRung::none);
  if (none >= 1.0f) return;
  const float masks = frame.techniques.share(Effect::puddles, PuddleRung::masks);
  const FrameCamera& camera = frame.camera;
  const float aspect = static_cast<float>(std::max(frame.width, 1)) / static_cast<float>(std::max(frame.height, 1));
  const Frustum frustum =
      frustum_of(view_projection_of(camera.orientation, camera.vertical_fov_rad, aspect, camera.near_m));

  auto out = std::make_shared<FramePuddles>();
  out->published = masks / (1.0f - none);
  std::vector<std::pair<float, FramePuddles::Puddle>> seen;
  registry.view<const Puddle, const WorldTransform>().each(
      [&](Entity entity, const Puddle& p, const WorldTransform& placed) {
        if (!(p.maximum_depth_mm > 0.0f)) return;  // nothing can stand here
        // Size is the component's; of the transform only place and turning count.
        glm::mat4 world(1.0f);
        for (int axis = 0; axis < 3; ++axis) {
          const glm::vec3 column(placed.matrix[axis]);
          world[axis] = glm::vec4(column / std::max(glm::length(column), 1e-20f), 0.0f);
        }
        world[3] = placed.matrix[3];
        const glm::vec3 centre(glm::dvec3(glm::vec3(world[3])) - camera.position_m);
        const float depth_m = 1e-3f * p.maximum_depth_mm;
        const glm::vec3 half(0.5f * p.size_m.x, depth_m + PUDDLE_BELOW_M, 0.5f * p.size_m.y);
        const glm::mat3 absolute(glm::abs(glm::vec3(world[0])), glm::abs(glm::vec3(world[1])),
                                 glm::abs(glm::vec3(world[2])));
        if (!box_touches(frustum, centre, absolute * half)) return;
        const float distance = glm::length(glm::max(glm::abs(centre) - absolute * half, glm::vec3(0.0f)));
        if (distance > PUDDLE_FARTHEST_M) return;
        FramePuddles::Puddle puddle;
        puddle.world_from_puddle = world;
        puddle.half_size_m = 0.5f * p.size_m;
        puddle.depth_m = depth_m;
        const PuddleWater* water = registry.find<PuddleWater>(entity);
        const float filled = water ? static_cast<float>(puddle_at(*water, frame.time_s).depth_m) : 0.0f;
        // Between rungs the level lies between theirs; none's lies at the bottom.
        puddle.level_m = (1.0f - none - masks) * filled + masks * depth_m;
        puddle.ripple_influence = p.ripple_influence;
        puddle.ripple_scale = p.ripple_scale;
        puddle.ripple_turn_rad = glm::radians(p.ripple_turn_deg);
        puddle.by_height = p.by_height;
        out->any_water |= puddle.level_m > 0.0f;
        seen.emplace_back(distance, puddle);
      });
  if (seen.empty()) return;
  std::stable_sort(seen.begin(), seen.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  seen.resize(std::min<std::size_t>(seen.size(), PUDDLES_AT_MOST));
  for (auto& [distance, puddle] : seen) out->puddles.push_back(puddle);
  frame.puddles = std::move(out);
}

}  // namespace petrichor
