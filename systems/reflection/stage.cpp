#include "systems/reflection/stage.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "systems/mirror_frame.hpp"

namespace petrichor {

void add_lit_box(Model& model, glm::vec3 low, glm::vec3 high, const StageLook& look, int only) {
  Material material;
  material.base_colour = glm::vec4(look.albedo, 1.0f);
  material.metallic = 0.0f;
  material.roughness = look.roughness;
  material.emissive = look.emissive;
  Primitive p;
  p.material = static_cast<std::int32_t>(model.materials.size());
  model.materials.push_back(material);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      if (only >= 0 && only != 2 * axis + side) continue;
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto base = static_cast<std::uint32_t>(p.vertices.size());
      for (int corner = 0; corner < 4; ++corner) {
        Vertex vertex;
        vertex.position_m[axis] = side ? high[axis] : low[axis];
        vertex.position_m[u] = corner & 1 ? high[u] : low[u];
        vertex.position_m[v] = corner & 2 ? high[v] : low[v];
        vertex.normal = glm::vec3(0.0f);
        vertex.normal[axis] = side ? 1.0f : -1.0f;
        vertex.tangent = glm::vec4(0.0f);
        vertex.tangent[u] = 1.0f;
        vertex.tangent.w = 1.0f;
        p.vertices.push_back(vertex);
      }
      const std::uint32_t front[6] = {0, 1, 2, 2, 1, 3}, back[6] = {0, 2, 1, 2, 3, 1};
      for (const std::uint32_t i : side ? front : back) p.indices.push_back(base + i);
    }
  p.bounds_min_m = low;
  p.bounds_max_m = high;
  Node node;
  node.mesh = static_cast<std::int32_t>(model.meshes.size());
  model.nodes.push_back(node);
  model.meshes.push_back({"box", {p}});
}

FrameLight stage_lamp(glm::vec3 position_m, glm::vec3 intensity_cd) {
  FrameLight light{};
  light.position_m = position_m;
  light.direction = {0, -1, 0};
  light.intensity = intensity_cd;
  light.range_m = 200.0f;
  light.outer_cone_rad = 0.785f;
  light.source_radius_m = 0.12f;
  light.kind = LIGHT_POINT;
  light.casts_shadow = true;
  return light;
}

StageScene night_street(float roughness, float eye_m) {
  StageScene s;
  s.name = "street";
  s.title = "A street at night";
  add_lit_box(s.model, {-12, -0.5f, -80}, {12, 0, 4},
              {glm::vec3(0.0f), roughness, {}});  // black: what is seen is mirrored
  const StageLook wall{glm::vec3(0.25f, 0.22f, 0.2f), 1.0f, {}};
  add_lit_box(s.model, {-7, 0, -80}, {-6.5f, 9, 4}, wall);
  add_lit_box(s.model, {6.5f, 0, -80}, {7, 9, 4}, wall);
  add_lit_box(s.model, {-7, 0, -80}, {7, 9, -79.5f}, wall);
  for (int i = 0; i < 5; ++i) {  // shop windows, and lit ones above; a sign
    const float z = -5.0f - 11.0f * static_cast<float>(i);
    const glm::vec3 warm(60, 42, 24), cool(20, 34, 52);
    add_lit_box(s.model, {-6.5f, 0.6f, z - 3}, {-6.45f, 2.8f, z}, {glm::vec3(0.0f), 1.0f, i % 2 ? cool : warm}, 1);
    add_lit_box(s.model, {6.45f, 4.2f, z - 5}, {6.5f, 5.8f, z - 4}, {glm::vec3(0.0f), 1.0f, warm}, 0);
  }
  add_lit_box(s.model, {6.2f, 2.6f, -14}, {6.3f, 3.4f, -11}, {glm::vec3(0.0f), 1.0f, {110, 8, 20}}, 0);
  const StageLook iron{glm::vec3(0.03f), 1.0f, {}};
  const float away[4] = {8, 16, 30, 50};
  for (int i = 0; i < 4; ++i) {
    const float x = i % 2 ? 4.5f : -4.5f, z = -away[i];
    add_lit_box(s.model, {x - 0.07f, 0, z - 0.07f}, {x + 0.07f, 4.3f, z + 0.07f}, iron);
    s.lights.push_back(stage_lamp({x, 4.6f, z}, glm::vec3(400, 240, 100) * (i % 2 ? 0.8f : 1.0f)));
  }
  for (int i = 0; i < 6; ++i) {
    const float x = i % 2 ? 3.6f : -3.4f, z = -4.5f - 2.7f * static_cast<float>(i);
    add_lit_box(s.model, {x - 0.09f, 0, z - 0.09f}, {x + 0.09f, 1.0f, z + 0.09f}, iron);
  }
  s.eye = {0.3f, eye_m, 2.0f};
  s.at = {0.0f, eye_m - 0.22f * 10.0f, -8.0f};
  return s;
}

Result<std::unique_ptr<ReflectionStage>> ReflectionStage::make(const MakePasses& passes, StageScene scene, int width,
                                                               int height,
                                                               const std::map<std::string, double>& parameters) {
  auto stage = std::make_unique<ReflectionStage>();
  stage->scene = std::move(scene);
  stage->graph_ = std::make_unique<Graph>(stage->shaders_, passes());
  nlohmann::json table = nlohmann::json::parse(R"json({
    "resources": {
      "depth": {"format": "depth32f"}, "albedo": {"format": "rgba8"}, "normal": {"format": "rgba16"},
      "emissive": {"format": "r11f_g11f_b10f"}, "highlights": {"format": "none"},
      "shadow_atlas": {"format": "rgba32f", "width": 2048, "height": 2048, "persistent": true},
      "environment": {"format": "rgba16f", "width": 448, "height": 65},
      "light_lists": {"format": "rgba32ui", "scale": 0.125}, "colour": {"format": "rgba16f"},
      "mirrors": {"format": "rgba16f", "scale": 0.5, "layers": 2, "mips": 6},
      "reflections": {"format": "rgba16f", "scale": 0.5}},
    "passes": [
      {"pass": "gbuffer", "depth": "depth", "albedo": "albedo", "normal": "normal", "emissive": "emissive"},
      {"pass": "shadow_maps", "shadow_atlas": "shadow_atlas"},
      {"pass": "environment", "environment": "environment", "shadow_atlas": "shadow_atlas"},
      {"pass": "light_lists", "depth": "depth", "albedo": "albedo", "normal": "normal",
       "shadow_atlas": "shadow_atlas", "light_lists": "light_lists", "parameters": {"threshold": 0.0003}},
      {"pass": "shade", "depth": "depth", "albedo": "albedo", "normal": "normal", "emissive": "emissive",
       "light_lists": "light_lists", "shadow_atlas": "shadow_atlas", "environment": "environment", "colour": "colour",
       "highlights": "highlights"},
      {"pass": "mirrors", "light_lists": "light_lists", "shadow_atlas": "shadow_atlas", "environment": "environment",
       "mirrors": "mirrors"},
      {"pass": "reflections", "depth": "depth", "albedo": "albedo", "normal": "normal", "emissive": "emissive",
       "environment": "environment", "highlights": "highlights", "colour": "colour",
       "reflections": "reflections"},
      {"pass": "reflections_over", "colour": "colour", "depth": "depth", "albedo": "albedo", "normal": "normal",
       "emissive": "emissive", "environment": "environment", "mirrors": "mirrors", "reflections": "reflections"}],
    "output": "colour"})json");
  for (auto& pass : table["passes"])
    for (const auto& [name, value] : parameters)
      if (pass["pass"] == (name == "published_edges" || name == "edge_exponent" || name == "distortion"
                               ? "reflections_over"
                               : "reflections"))
        pass["parameters"][name] = value;
  if (auto loaded = stage->graph_->load_table(table, "the stage of reflections"); !loaded)
    return tl::unexpected(loaded.error());

  Frame& frame = stage->frame;
  stage->models_ = {std::make_shared<const Model>(stage->scene.model)};
  stage->gpu_scene_.add(*stage->models_.front());
  frame.scene = &stage->gpu_scene_;
  frame.width = width;
  frame.height = height;
  frame.geometry_version = frame.lights_version = 1;
  frame.camera.bloom = 0.0f;
  frame.camera.exposure_ev100 = 3.0f;
  frame.camera.vertical_fov_rad = stage->scene.vertical_fov_rad;
  frame.sky = {glm::vec3(0.005f, 0.007f, 0.012f), glm::vec3(0.05f, 0.04f, 0.03f), 0.25f, 1.0f};
  for (std::uint32_t i = 0; i < stage->scene.model.meshes.size(); ++i)
    frame.instances.push_back({0, i, true, glm::mat4(1.0f)});
  frame.lights = stage->scene.lights;
  stage->look(stage->scene.eye, stage->scene.at);
  return stage;
}

void ReflectionStage::look(glm::vec3 eye, glm::vec3 at) {
  const glm::vec3 back = glm::normalize(eye - at);
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back));
  frame.camera.position_m = eye;
  frame.camera.orientation = glm::quat_cast(glm::mat3(right, glm::cross(back, right), back));
}

void ReflectionStage::use(ReflectionRung rung) {
  frame.techniques.set(Effect::reflections, rung);
}

Result<const Texture*> ReflectionStage::execute(FrameTimer& timer) {
  frame.reflectors.reset();
  extract_reflectors(finder_, models_, frame);
  frame.mirrors.reset();
  if (frame.techniques.share(Effect::reflections, ReflectionRung::planar) > 0.0f) {  // the ground is level, at 0
    auto mirrors = std::make_shared<FrameMirrors>();
    mirrors->water = FrameMirrors::Plane{};
    mirrors->water->eye_m = static_cast<float>(frame.camera.position_m.y);
    mirrors->water->coverage = 0.35f;
    frame.mirrors = std::move(mirrors);
  }
  finish_frame(frame);
  gpu_.upload(frame);
  return graph_->execute(frame, frame.width, frame.height, timer);
}

Result<std::vector<glm::vec4>> ReflectionStage::draw() {
  FrameTimer timer(true);
  timer.begin_frame(false);
  auto drawn = execute(timer);
  timer.end_frame();
  if (!drawn) return tl::unexpected(drawn.error());
  std::vector<glm::vec4> pixels(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  glGetTextureImage((*drawn)->id, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(pixels.size() * sizeof(glm::vec4)),
                    pixels.data());
  return pixels;
}

Result<double> ReflectionStage::time(bool software) {
  FrameTimer timer(software);
  timer.begin_frame(true);
  auto drawn = execute(timer);
  timer.end_frame();
  if (!drawn) return tl::unexpected(drawn.error());
  double sum = 0.0;
  glFinish();
  for (const Timing& t : timer.collect())
    if (t.name == "mirrors" || t.name == "reflections" || t.name == "reflections_over") sum += t.milliseconds;
  return sum;
}

}  // namespace petrichor
