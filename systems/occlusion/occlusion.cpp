#include "systems/occlusion/occlusion.hpp"

#include <cmath>
#include <memory>

#include "systems/gpu_scene.hpp"

namespace petrichor {
namespace {

// Metres to the lattice on which the map's ends lie, so that rounding of the scene's box does not move them.
constexpr double end_step_m = 8.0;
constexpr double end_margin_m = 1.37;  // no round number: roofs and floors are often at whole metres

struct MapState {
  OcclusionPlacement placement;
  std::uint64_t geometry_version = 0;
  const GpuScene* scene = nullptr;
  bool drawn = false;
  Buffer uniforms;
};

// Drawn about the map's own middle, not about the camera: rounding, and so every texel, is the same whichever frame
// happens to draw it. A range of frames is then the same bytes as a part of a longer run.
void redraw(PassContext& context, const OcclusionPlacement& p) {
  Frame about_map;
  about_map.instances = context.frame.instances;
  about_map.camera.position_m = p.corner_m + glm::dvec3(p.right + p.up) * (0.5 * static_cast<double>(p.side_m)) +
                                glm::dvec3(p.fall) * (0.5 * static_cast<double>(p.depth_m));
  GpuScene& scene = *context.frame.scene;
  upload_instances(scene, about_map);
  context.bind_framebuffer({}, "occlusion_map");
  glViewport(0, 0, p.texels, p.texels);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glDisable(GL_CULL_FACE);  // a roof shelters whichever way its triangles face
  const float nothing = 0.0f;
  glClearBufferfv(GL_DEPTH, 0, &nothing);
  const glm::mat4 clip = occlusion_clip(p, about_map.camera.position_m);
  const Program& program = context.program("depth");
  program.use();
  program.set("clip_from_relative", clip);
  draw_instances(scene, about_map, clip, DrawWhat::shelter);
  glDisable(GL_DEPTH_TEST);
  upload_instances(scene, context.frame);  // what the other passes draw is relative to the camera
}

void draw_map(PassContext& context, MapState& state) {
  const Frame& frame = context.frame;
  glm::vec3 low, high;
  OcclusionUniforms uniforms{};
  const bool anything = frame.scene && scene_bounds(*frame.scene, low, high);
  if (anything) {
    const glm::vec3 fall =
        lattice_direction(frame.rain->mean_velocity_mps, glm::radians(context.parameter("tolerance_deg")));
    const int texels = context.texture("occlusion_map").width;
    const OcclusionPlacement placement = place_occlusion_map(frame.camera.position_m, fall, context.parameter("side_m"),
                                                             texels, context.parameter("step_m"), low, high);
    const bool stale = context.fresh("occlusion_map") || !state.drawn || state.placement != placement ||
                       state.geometry_version != frame.geometry_version || state.scene != frame.scene;
    if (stale) {
      redraw(context, placement);
      state.placement = placement;
      state.geometry_version = frame.geometry_version;
      state.scene = frame.scene;
      state.drawn = true;
    }
    const float texel_m = placement.side_m / static_cast<float>(texels);
    // Level ground changes its depth along the fall by tan(tilt) per metre: half a texel's diagonal of that is
    // what a texel's centre may differ from the place itself.
    const float down = std::max(-fall.y, 0.1f);
    const float steepness = std::sqrt(std::max(1.0f - down * down, 0.0f)) / down;
    uniforms.map_from_relative = occlusion_matrix(placement, frame.camera.position_m);
    uniforms.fall_texel = {fall, texel_m};
    uniforms.size_depth = {static_cast<float>(texels), placement.depth_m,
                           context.parameter("bias_m") + 0.71f * texel_m * steepness, 0.0f};
  }
  upload(state.uniforms, &uniforms, sizeof uniforms);
  glBindBufferRange(GL_UNIFORM_BUFFER, OCCLUSION_UNIFORMS_BINDING, state.uniforms.id, 0, sizeof uniforms);
}

}  // namespace

glm::vec3 lattice_direction(const glm::vec3& fall, float tolerance_rad) {
  const float length = glm::length(fall);
  if (!(length > 0.0f)) return {0.0f, -1.0f, 0.0f};
  const glm::vec3 d = fall / length;
  // Tilt as a flat vector: its length is the angle from straight down. Half a cell's diagonal is the tolerance.
  const float sine = std::hypot(d.x, d.z);
  const float angle = std::atan2(sine, -d.y);
  glm::vec2 tilt = sine > 1e-9f ? glm::vec2(d.x, d.z) / sine * angle : glm::vec2(0.0f);
  if (tolerance_rad > 0.0f) tilt = glm::round(tilt / (1.41421356f * tolerance_rad)) * (1.41421356f * tolerance_rad);
  const float snapped = glm::length(tilt);
  if (snapped < 1e-9f) return {0.0f, -1.0f, 0.0f};
  const glm::vec2 way = tilt / snapped * std::sin(snapped);
  return {way.x, -std::cos(snapped), way.y};
}

OcclusionPlacement place_occlusion_map(const glm::dvec3& camera_m, const glm::vec3& fall, float side_m, int texels,
                                       float step_m, const glm::vec3& low_m, const glm::vec3& high_m) {
  OcclusionPlacement p;
  p.fall = fall;
  p.side_m = side_m;
  p.texels = texels;
  // Along x as far as the fall lets it; falling along x itself, along z.
  const glm::vec3 reference = std::abs(fall.x) < 0.9f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 0.0f, 1.0f);
  p.right = glm::normalize(reference - fall * glm::dot(reference, fall));
  p.up = glm::cross(-p.fall, p.right);

  // Whole texels, so that what is redrawn falls on the same samples.
  const double texel = static_cast<double>(side_m) / texels;
  const double step = std::max(1.0, std::round(step_m / texel)) * texel;
  const auto snapped = [&](const glm::vec3& axis) {
    return std::round(glm::dot(camera_m, glm::dvec3(axis)) / step) * step - 0.5 * side_m;
  };
  const glm::dvec3 centre = glm::dvec3(0.5f * (low_m + high_m)) + camera_m;
  const double reach = glm::dot(glm::dvec3(0.5f * (high_m - low_m)), glm::abs(glm::dvec3(fall)));
  const double middle = glm::dot(centre, glm::dvec3(fall));
  const double upper = std::floor((middle - reach - end_margin_m) / end_step_m) * end_step_m;
  const double lower = std::ceil((middle + reach + end_margin_m) / end_step_m) * end_step_m;
  p.depth_m = static_cast<float>(lower - upper);
  p.corner_m = glm::dvec3(p.right) * snapped(p.right) + glm::dvec3(p.up) * snapped(p.up) + glm::dvec3(p.fall) * upper;
  return p;
}

glm::mat4 occlusion_matrix(const OcclusionPlacement& p, const glm::dvec3& camera_m) {
  const glm::dvec3 origin = camera_m - p.corner_m;
  const glm::dvec3 right = glm::dvec3(p.right) / static_cast<double>(p.side_m);
  const glm::dvec3 up = glm::dvec3(p.up) / static_cast<double>(p.side_m);
  const glm::dvec3 fall(p.fall);
  glm::dmat4 rows(1.0);
  rows[0] = glm::dvec4(right, glm::dot(right, origin));
  rows[1] = glm::dvec4(up, glm::dot(up, origin));
  rows[2] = glm::dvec4(fall, glm::dot(fall, origin));
  return glm::mat4(glm::transpose(rows));
}

glm::mat4 occlusion_clip(const OcclusionPlacement& p, const glm::dvec3& camera_m) {
  glm::mat4 clip_from_map(1.0f);
  clip_from_map[0][0] = clip_from_map[1][1] = 2.0f;
  clip_from_map[2][2] = -1.0f / p.depth_m;
  clip_from_map[3] = {-1.0f, -1.0f, 1.0f, 1.0f};
  return clip_from_map * occlusion_matrix(p, camera_m);
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
             {"jittered", "several maps, seen along falls of drops of all sizes", {"occlusion_map"}}};
  l.coverage = [](const Frame& frame) { return frame.rain && frame.rain->rain_mm_per_hour > 0.0f ? 0.2 : 0.0; };
  l.directed = false;
  return l;
}

std::vector<PassOffer> occlusion_passes() {
  auto state = std::make_shared<MapState>();
  std::vector<PassOffer> offers;
  offers.push_back({"occlusion_map",
                    "depth along the fall of the rain: what is under a roof",
                    {{"occlusion_map", SlotAccess::write}},
                    {{"side_m", 128.0}, {"step_m", 16.0}, {"tolerance_deg", 0.5}, {"bias_m", 0.02}},
                    {{"depth", {{"systems/geometry/depth.vert.glsl", "systems/geometry/depth.frag.glsl"}, {}}}},
                    [](const Frame& frame) { return frame.rain && frame.rain->rain_mm_per_hour > 0.0f; },
                    [state](PassContext& context) { draw_map(context, *state); }});
  return offers;
}

}  // namespace petrichor
