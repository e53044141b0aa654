#include "systems/occlusion/occlusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "components/weather.hpp"
#include "engine/ecs/registry.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/occlusion/falls.hpp"
#include "systems/wetness_frame.hpp"

namespace petrichor {
namespace {

struct DrawnMap {
  GLuint texture = 0;  // of all maps
  GLint index = 0;     // of its layer
  OcclusionPlacement placement;
  Framebuffer layer;
  bool drawn = false;
};

struct MapState {
  std::vector<DrawnMap> maps;
  GLuint texture = 0;
  std::uint64_t geometry_version = 0;
  const GpuScene* scene = nullptr;
  Buffer uniforms;
  std::vector<float> asked;  // of chosen_falls, and its answer: the weather seldom changes from frame to frame
  std::vector<FallShare> falls;
};

OcclusionRung rung_of(const Frame& frame) {
  const Choice& c = frame.techniques[Effect::occlusion];
  return static_cast<OcclusionRung>(c.blend >= 0.5f ? c.rung : c.from);
}

std::vector<float> question(const Frame& frame, int count) {
  std::vector<float> all{static_cast<float>(count)};
  if (frame.wind) {
    const Wind& w = *frame.wind;
    all.insert(all.end(),
               {w.velocity_mps.x, w.velocity_mps.y, w.velocity_mps.z, w.gust_mps, w.gust_period_s, w.swirl_mps});
  }
  const auto add = [&](float rate, float number, float diameter, float speed, const glm::vec3& velocity) {
    all.insert(all.end(), {rate, number, diameter, speed});
    if (!frame.wind) all.insert(all.end(), {velocity.x, velocity.y, velocity.z});
  };
  if (frame.rain)
    for (const RainClass& c : frame.rain->classes)
      add(frame.rain->rain_mm_per_hour, c.drops_per_m3, c.diameter_mm, c.fall_speed_mps, c.velocity_mps);
  if (frame.snow)
    for (const SnowClass& c : frame.snow->classes)
      add(frame.snow->snow_mm_per_hour, c.flakes_per_m3, c.diameter_mm, c.fall_speed_mps, c.velocity_mps);
  return all;
}

// Something is still wet from rain that has stopped: where, the maps along its fall say.
bool is_wet(const Frame& frame) {
  return frame.wetness && frame.wetness->rain;
}

// The directions of this frame's maps and their shares: on the lattice, each once.
std::vector<FallShare> directions(const PassContext& context, const Frame& frame, MapState& state, int most) {
  const OcclusionRung rung = rung_of(frame);
  if (rung == OcclusionRung::vertical) return {{{0.0f, -1.0f, 0.0f}, 1.0f}};
  const float tolerance = glm::radians(context.parameter("tolerance_deg"));
  if (rung == OcclusionRung::tilted) return {{lattice_direction(mean_fall(frame), tolerance), 1.0f}};
  const int count = std::clamp(static_cast<int>(std::lround(context.parameter("maps"))), 1, most);
  if (std::vector<float> asked = question(frame, count); asked != state.asked) {
    state.asked = std::move(asked);
    state.falls = chosen_falls(frame, count);
  }
  std::vector<FallShare> found;
  for (const FallShare& f : state.falls) {
    const glm::vec3 way = lattice_direction(f.velocity_mps, tolerance);
    const auto same =
        std::find_if(found.begin(), found.end(), [&](const FallShare& g) { return g.velocity_mps == way; });
    if (same != found.end())
      same->share += f.share;  // in still air all fall straight down: one map is enough
    else
      found.push_back({way, f.share});
  }
  return found;
}

// Drawn about the map's own middle, not about the camera: rounding, and so every texel, is the same whichever frame
// happens to draw it. A range of frames is then the same bytes as a part of a longer run.
void redraw(PassContext& context, const DrawnMap& map) {
  const OcclusionPlacement& p = map.placement;
  Frame about_map;
  about_map.instances = context.frame.instances;
  about_map.camera.position_m = p.corner_m + glm::dvec3(p.right + p.up) * (0.5 * static_cast<double>(p.side_m)) +
                                glm::dvec3(p.fall) * (0.5 * static_cast<double>(p.depth_m));
  GpuScene& scene = *context.frame.scene;
  upload_instances(scene, about_map);
  glBindFramebuffer(GL_FRAMEBUFFER, map.layer);
  glViewport(0, 0, p.texels, p.texels);
  // Not by the framebuffer: on NVIDIA (driver 580) a map that was made after one of several layers had been freed then
  // kept the old one's coarse depths, and roofs were missing in it.
  const float nothing = 0.0f;
  glClearTexSubImage(map.texture, 0, 0, 0, map.index, p.texels, p.texels, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &nothing);
  const glm::mat4 clip = occlusion_clip(p, about_map.camera.position_m);
  const Program& program = context.program("depth");
  program.use();
  program.set("clip_from_relative", clip);
  draw_instances(scene, about_map, clip, DrawWhat::shelter);
}

// A framebuffer for each layer of the maps' texture.
void take_texture(MapState& state, const Texture& texture, bool fresh) {
  const auto layers = static_cast<std::size_t>(std::min(texture.layers, OCCLUSION_MAPS));
  if (!fresh && state.texture == texture.id && state.maps.size() == layers) return;
  state.texture = texture.id;
  state.maps.clear();
  state.maps.resize(layers);
  for (std::size_t i = 0; i < layers; ++i) {
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    state.maps[i].layer = Framebuffer(id);
    state.maps[i].texture = texture.id;
    state.maps[i].index = static_cast<GLint>(i);
    glNamedFramebufferTextureLayer(id, GL_DEPTH_ATTACHMENT, texture.id, 0, static_cast<GLint>(i));
    glNamedFramebufferDrawBuffer(id, GL_NONE);
    glNamedFramebufferReadBuffer(id, GL_NONE);
  }
}

void draw_maps(PassContext& context, MapState& state) {
  const Frame& frame = context.frame;
  const Texture& texture = context.texture("occlusion_map");
  take_texture(state, texture, context.fresh("occlusion_map"));
  glm::vec3 low, high;
  OcclusionUniforms uniforms{};
  if (frame.scene && scene_bounds(*frame.scene, low, high)) {
    if (state.geometry_version != frame.geometry_version || state.scene != frame.scene)
      for (DrawnMap& map : state.maps) map.drawn = false;
    state.geometry_version = frame.geometry_version;
    state.scene = frame.scene;
    // The weather that the maps are for: that of now, or that which left things wet.
    Frame past;
    if (!precipitates(frame) && is_wet(frame)) {
      past.techniques = frame.techniques;
      past.rain = frame.wetness->rain;
      past.wind = frame.wetness->wind;
    }
    const Frame& weather = past.rain ? past : frame;
    // Behind them, where there is room, one along a fall that is remembered for what it wetted.
    const bool remembers = is_wet(frame) && frame.wetness->remembered > 1 && state.maps.size() > 1;
    const int most = static_cast<int>(state.maps.size()) - (remembers ? 1 : 0);
    std::vector<FallShare> falls = directions(context, weather, state, most);
    const auto present = static_cast<std::uint32_t>(falls.size());
    if (remembers)
      falls.push_back({lattice_direction(frame.wetness->remembered_fall_mps,
                                         glm::radians(context.parameter("tolerance_deg"))),
                       0.0f});
    const float step = context.parameter("step_m"),
                texel_m = context.parameter("side_m") / static_cast<float>(texture.width);
    const bool published = context.parameter("published") != 0.0f;
    const glm::vec3 mean = mean_fall(weather);
    bool drew = false;
    for (std::size_t i = 0; i < falls.size(); ++i) {
      DrawnMap& map = state.maps[i];
      // Each map steps elsewhere, so that a walk redraws them one by one; the shifts are no whole texels either, so
      // that the steps of the maps' edges do not fall together. (The plastic number's sequence covers the plane
      // evenly.)
      const double n = static_cast<double>(i);
      const glm::dvec2 shift =
          glm::dvec2(std::fmod(n * 0.7548776662, 1.0), std::fmod(n * 0.5698402910, 1.0)) * double(step);
      const OcclusionPlacement placement =
          place_occlusion_map(frame.camera.position_m, falls[i].velocity_mps, context.parameter("side_m"),
                              texture.width, step, low, high, shift);
      if (!map.drawn || map.placement != placement) {
        if (!drew) {
          glEnable(GL_DEPTH_TEST);
          glDepthFunc(GL_GREATER);
          glDepthMask(GL_TRUE);
          glDisable(GL_CULL_FACE);  // a roof shelters whichever way its triangles face
          drew = true;
        }
        map.placement = placement;
        map.drawn = true;
        ++uniforms.counts.z;
        redraw(context, map);
      }
      // Level ground changes its depth along the fall by tan(tilt) per metre: half a texel's diagonal of that is
      // what a texel's centre may differ from the place itself. Chen compares the depths as they are.
      const glm::vec3& fall = placement.fall;
      const float down = std::max(-fall.y, 0.1f);
      const float steepness = std::sqrt(std::max(1.0f - down * down, 0.0f)) / down;
      const float bias_m = published ? 0.0f : context.parameter("bias_m") + 0.71f * texel_m * steepness;
      uniforms.map_from_relative[i] = occlusion_matrix(placement, frame.camera.position_m);
      uniforms.fall_texel[i] = {fall, texel_m};
      uniforms.size_depth[i] = {static_cast<float>(texture.width), placement.depth_m, bias_m, falls[i].share};
      const glm::vec3 nearest = uniforms.fall_texel[uniforms.counts.y];
      if (i < present && glm::dot(fall, mean) > glm::dot(nearest, mean)) uniforms.counts.y = static_cast<std::uint32_t>(i);
    }
    uniforms.counts.x = present;
    uniforms.counts.w = remembers ? 1 : 0;
    if (drew) {
      glDisable(GL_DEPTH_TEST);
      upload_instances(*frame.scene, frame);  // what the other passes draw is relative to the camera
    }
  }
  upload(state.uniforms, &uniforms, sizeof uniforms);
  glBindBufferRange(GL_UNIFORM_BUFFER, OCCLUSION_UNIFORMS_BINDING, state.uniforms.id, 0, sizeof uniforms);
}

}  // namespace

void extract_wind(const Registry& registry, Frame& frame) {
  Entity first{};
  registry.view<Wind>().each([&](Entity e, const Wind& found) {
    if (!frame.wind || entity_index(e) < entity_index(first)) first = e, frame.wind = found;
  });
}

Ladder occlusion_ladder() {
  Ladder l;
  l.effect = Effect::occlusion;
  l.name = "occlusion";
  l.meaning = "shelter from what falls";
  l.truth = "rays (Embree) along the paths of the drops";
  l.error_measure = "root mean square of the share of rain that arrives, 0 to 1";
  l.rungs = {{"vertical", "one map, seen from straight above (Chen)", {"occlusion_map"}},
             {"tilted", "one map, seen along the mean fall", {"occlusion_map"}},
             {"jittered", "several maps, seen along the falls of drops of all sizes and of gusts", {"occlusion_map"}}};
  l.coverage = [](const Frame& frame) { return precipitates(frame) ? 0.2 : 0.0; };
  // Errors of the chart `occlusion`, relative to no shelter at all (0.40). Costs are those of a redraw, which a frame
  // seldom pays.
  for (std::size_t i = 0; i < l.rungs.size(); ++i) l.rungs[i].chart_error = std::array{1.2, 0.4, 0.1}[i];
  l.rungs[0].stable = false;  // in any wind
  l.directed = false;
  return l;
}

std::vector<PassOffer> occlusion_passes() {
  auto state = std::make_shared<MapState>();
  std::vector<PassOffer> offers;
  offers.push_back({"occlusion_map",
                    "depth along the fall of rain and snow, a layer for each of several falls: what is under a roof",
                    {{"occlusion_map", SlotAccess::write}},
                    {{"side_m", 128.0},
                     {"step_m", 16.0},
                     {"tolerance_deg", 0.5},
                     {"bias_m", 0.02},
                     {"maps", 8.0},
                     {"published", 0.0}},
                    {{"depth", {{"systems/geometry/depth.vert.glsl", "systems/geometry/depth.frag.glsl"}, {}}}},
                    [](const Frame& frame) { return precipitates(frame) || is_wet(frame); },
                    [state](PassContext& context) { draw_maps(context, *state); }});
  return offers;
}

}  // namespace petrichor
