#include "systems/splash/overhead.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "systems/drops/sums.hpp"
#include "systems/splash_frame.hpp"

namespace petrichor {
namespace {

struct GlowGpu {
  glm::vec4 place_normal_x, intensity_normal_y, normal_z;
};

void draw_overhead(OverheadState& state, PassContext& context) {
  const Frame& frame = context.frame;
  const FrameSplashes& splashes = *frame.splashes;
  // Anew for each frame, so that none depends on which were drawn before: heights by the maps of shelter change with
  // all that moves. The square stands still in the world, so that its texels do not swim.
  const glm::dvec2 at(frame.camera.position_m.x, frame.camera.position_m.z);
  const glm::dvec2 middle = glm::floor(at / overhead_step_m + 0.5) * overhead_step_m;
  state.middle_m = middle;
  std::vector<GlowGpu> glows;
  for (const SplashGlow& g : splashes.glows) {
    const glm::vec3 place(glm::dvec3(g.place_m) - frame.camera.position_m);
    glows.push_back({glm::vec4(place, g.normal.x), glm::vec4(g.intensity, g.normal.y), glm::vec4(g.normal.z, 0, 0, 0)});
  }
  if (glows.empty()) glows.emplace_back();
  upload(state.glows, std::span<const GlowGpu>(glows));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 9, state.glows.id);
  const Program& program = context.program("overhead");
  program.use();
  program.set("glow_count", static_cast<unsigned>(splashes.glows.size()));
  program.set("middle_side", glm::vec3(glm::vec2(middle - at), static_cast<float>(overhead_side_m)));
  // Only what splashes may ask: the whole square costs software OpenGL 50 ms.
  state.reach_m = splashes.reach_m;
  const bool software = is_software_gl();
  if (software && context.parameter("software_reach") > 0.0f)
    state.reach_m = std::min(state.reach_m, context.parameter("software_reach"));
  const Texture& map = context.texture("overhead");
  const int block = software ? 2 : 1;
  const double texel_m = overhead_side_m / map.width;
  const auto texel = [&](double off_m) {
    const int i = static_cast<int>(std::floor(off_m / texel_m)) + map.width / 2;
    return std::clamp(i - (i % block), 0, map.width);
  };
  const double wide = state.reach_m + 2.0 * block * texel_m;
  const glm::dvec2 eye = at - middle;
  const glm::ivec2 first(texel(eye.x - wide), texel(eye.y - wide)), last(texel(eye.x + wide), texel(eye.y + wide));
  program.set("first_block", glm::vec3(glm::vec2(first), static_cast<float>(block)));
  program.set("has_map", int(context.has("occlusion_map")));
  if (context.has("occlusion_map")) context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
  context.bind_image(0, "overhead", GL_WRITE_ONLY);
  program.dispatch((last.x - first.x + block - 1) / block, (last.y - first.y + block - 1) / block);
}

}  // namespace

PassOffer overhead_pass(std::shared_ptr<OverheadState> state) {
  PassOffer offer;
  offer.name = "splash_overhead";
  offer.meaning = "light from above by windows and signs, for splashes";
  offer.slots = {{"overhead", SlotAccess::write}, {"occlusion_map", SlotAccess::read, true}};
  offer.parameters = {{"software_reach", 8}};
  offer.shaders = {{"overhead", {{"systems/splash/splash_overhead.comp.glsl"}, {}}}};
  offer.wanted = [](const Frame& frame) { return frame.splashes && !frame.splashes->glows.empty(); };
  offer.execute = [state](PassContext& context) { draw_overhead(*state, context); };
  return offer;
}

glm::vec4 overhead_place(const OverheadState& state, const Frame& frame, float known_lux) {
  const glm::dvec2 at(frame.camera.position_m.x, frame.camera.position_m.z);
  return {glm::vec2(state.middle_m - at), static_cast<float>(overhead_side_m), known_lux};
}

float overhead_at_camera(const Frame& frame) {
  glm::vec3 lux(0.0f);
  for (const SplashGlow& g : frame.splashes->glows) {
    const glm::vec3 way(frame.camera.position_m - glm::dvec3(g.place_m));
    const float d2 = glm::dot(way, way) + 0.05f;
    const float facing =
        glm::dot(g.normal, g.normal) > 0.5f ? std::max(glm::dot(way, g.normal) / std::sqrt(d2), 0.0f) : 1.0f;
    lux += g.intensity * (facing / d2);
  }
  return std::max({lux.r, lux.g, lux.b});
}

}  // namespace petrichor
