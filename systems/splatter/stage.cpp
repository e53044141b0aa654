#include "systems/splatter/stage.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "systems/drops/drop_sizes.hpp"
#include "systems/splatter/mist.hpp"
#include "systems/splatter/splatter.hpp"

namespace petrichor {
namespace {

Model one_mesh(Primitive primitive) {
  Model model;
  model.materials.emplace_back();
  primitive.material = 0;
  Mesh mesh;
  mesh.primitives.push_back(std::move(primitive));
  model.meshes.push_back(std::move(mesh));
  Node node;
  node.mesh = 0;
  model.nodes.push_back(node);
  return model;
}

}  // namespace

Model box_model(const glm::vec3& half, float bottom_m) {
  Primitive p;
  const glm::vec3 low(-half.x, bottom_m, -half.z), high(half.x, bottom_m + 2.0f * half.y, half.z);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto first = static_cast<std::uint32_t>(p.vertices.size());
      for (int corner = 0; corner < 4; ++corner) {
        Vertex vertex;
        vertex.position_m[axis] = side ? high[axis] : low[axis];
        vertex.position_m[u] = corner == 1 || corner == 2 ? high[u] : low[u];
        vertex.position_m[v] = corner >= 2 ? high[v] : low[v];
        vertex.normal = glm::vec3(0.0f);
        vertex.normal[axis] = side ? 1.0f : -1.0f;
        p.vertices.push_back(vertex);
      }
      for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u})
        p.indices.push_back(first + (side || i == 0u ? i : 4u - i));
    }
  p.bounds_min_m = low;
  p.bounds_max_m = high;
  return one_mesh(std::move(p));
}

Model body_model(int around, int along) {
  // Half a squarish ellipsoid on end walls: roof round across, falling towards both ends.
  Primitive p;
  const auto place = [&](int i, int j) {
    const float u = 3.14159265f * static_cast<float>(i) / static_cast<float>(around);
    const float v = -1.0f + 2.0f * static_cast<float>(j) / static_cast<float>(along);
    const auto power = [](float x, float e) { return std::copysign(std::pow(std::abs(x), e), x); };
    const float full = std::pow(std::max(1.0f - std::pow(std::abs(v), 4.0f), 0.0f), 0.5f);
    return glm::vec3(0.8f * power(std::cos(u), 0.5f) * (0.35f + 0.65f * full),
                     0.25f + 1.15f * std::pow(std::sin(u), 0.5f) * full, 2.0f * v);
  };
  for (int j = 0; j <= along; ++j)
    for (int i = 0; i <= around; ++i) {
      Vertex vertex;
      vertex.position_m = place(i, j);
      const glm::vec3 du = place(std::min(i + 1, around), j) - place(std::max(i - 1, 0), j);
      const glm::vec3 dv = place(i, std::min(j + 1, along)) - place(i, std::max(j - 1, 0));
      const glm::vec3 n = glm::cross(du, dv);
      vertex.normal = glm::length(n) > 1e-9f ? glm::normalize(n) : glm::vec3(0.0f, 0.0f, j == 0 ? -1.0f : 1.0f);
      p.vertices.push_back(vertex);
    }
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (around + 1) + i), b = a + static_cast<std::uint32_t>(around) + 1;
      for (const std::uint32_t k : {a, b + 1, b, a, a + 1, b + 1}) p.indices.push_back(k);
    }
  p.bounds_min_m = {-0.8f, 0.25f, -2.0f};
  p.bounds_max_m = {0.8f, 1.4f, 2.0f};
  return one_mesh(std::move(p));
}

FrameRain still_rain(float rain_mm_per_hour, std::uint32_t seed) {
  Emitter emitter;
  emitter.rain_mm_per_hour = rain_mm_per_hour;
  FrameRain rain;
  rain.rain_mm_per_hour = rain_mm_per_hour;
  rain.seed = seed;
  rain.mean_velocity_mps = {0.0f, -7.0f, 0.0f};
  for (const DropClass& c : make_drop_classes(emitter)) {
    RainClass out{};
    out.diameter_mm = static_cast<float>(c.diameter_mm);
    out.fall_speed_mps = static_cast<float>(c.fall_speed_mps);
    out.drops_per_m3 = static_cast<float>(c.drops_per_m3);
    out.drawn = false;
    out.velocity_mps = {0.0f, -out.fall_speed_mps, 0.0f};
    rain.classes.push_back(out);
  }
  return rain;
}

void look(FrameCamera& camera, const glm::vec3& from, const glm::vec3& at, float fov_deg) {
  camera.position_m = glm::dvec3(from);
  const glm::vec3 z = glm::normalize(from - at);
  const glm::vec3 x = glm::normalize(glm::cross(std::abs(z.y) < 0.999f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1), z));
  camera.orientation = glm::quat_cast(glm::mat3(x, glm::cross(z, x), z));
  camera.vertical_fov_rad = glm::radians(fov_deg);
}

Result<std::unique_ptr<SplatterStage>> SplatterStage::make(bool software_gl, std::vector<PassOffer> more) {
  std::unique_ptr<SplatterStage> stage(new SplatterStage(software_gl));
  SplatterStage* self = stage.get();
  PassOffer scene;
  scene.name = "stage_scene";
  scene.slots = {{"depth", SlotAccess::write}, {"normal", SlotAccess::write}, {"colour", SlotAccess::write}};
  scene.shaders = {{"scene", {{"systems/splatter/stage.vert.glsl", "systems/splatter/stage.frag.glsl"}, {}}}};
  scene.execute = [self](PassContext& context) {
    clear_texture(context.texture("colour"),
                  {self->background_cd_m2.x, self->background_cd_m2.y, self->background_cd_m2.z, 1.0f});
    self->depth_ = context.texture("depth").id;
    self->normal_ = context.texture("normal").id;
    static constexpr std::array<std::string_view, 1> colours{"normal"};
    context.bind_framebuffer(colours, "depth");
    const float zero[4] = {0, 0, 0, 0};
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    glClearBufferfv(GL_DEPTH, 0, zero);
    glClearBufferfv(GL_COLOR, 0, zero);
    context.program("scene").use();
    draw_instances(self->scene_, context.frame, context.frame.uniforms.view_projection, DrawWhat::opaque);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
  };
  nlohmann::json table;
  table["resources"] = {
      {"depth", {{"format", "depth32f"}}},
      {"normal", {{"format", "rgba16"}}},
      {"colour", {{"format", "rgba16f"}}},
      {"map", {{"format", "depth32f"}, {"width", 512}, {"height", 512}, {"layers", 1}, {"persistent", true}}}};
  table["passes"] = nlohmann::json::array();
  table["passes"].push_back({{"pass", "stage_scene"}, {"depth", "depth"}, {"normal", "normal"}, {"colour", "colour"}});
  nlohmann::json splatter = {{"pass", "splatter"}, {"colour", "colour"}, {"depth", "depth"}, {"normal", "normal"}};
  nlohmann::json halos = {{"pass", "halos"}, {"colour", "colour"}, {"depth", "depth"}};
  for (const PassOffer& offer : more) {
    if (offer.name != "occlusion_map") continue;
    table["passes"].push_back(
        {{"pass", "occlusion_map"}, {"occlusion_map", "map"}, {"parameters", {{"side_m", 16.0}}}});
    splatter["occlusion_map"] = halos["occlusion_map"] = "map";
  }
  table["passes"].push_back(splatter);
  table["passes"].push_back(halos);
  table["output"] = "colour";
  std::vector<PassOffer> offers = splatter_passes(DropPainting{});
  for (PassOffer& offer : more) offers.push_back(std::move(offer));
  offers.push_back(std::move(scene));
  stage->graph_ = std::make_unique<Graph>(stage->library_, std::move(offers));
  stage->table_ = std::move(table);
  stage->frame.scene = &stage->scene_;
  stage->frame.sky.zenith_cd_m2 = stage->frame.sky.horizon_cd_m2 = glm::vec3(0.0f);
  return stage;
}

std::size_t SplatterStage::add(const Model& model, const glm::mat4& matrix, bool marked) {
  models_.push_back(std::make_shared<const Model>(model));
  const std::uint32_t index = scene_.add(model);
  const auto instance = static_cast<std::uint32_t>(frame.instances.size());
  frame.instances.push_back({index, 0, true, matrix, 100 + instance});
  if (marked)
    marks.push_back({instance, std::shared_ptr<const Mesh>(models_.back(), &models_.back()->meshes[0]), 100 + instance,
                     1.0f, 1.0f, 1.0f, 6, 0.006f, false});
  return instance;
}

Result<void> SplatterStage::draw() {
  ++frame.number;
  ++frame.geometry_version;
  auto splatter = std::make_shared<FrameSplatter>();
  splatter->catchers = marks;
  if (frame.rain) splatter->mist = splash_mist(*frame.rain);
  frame.splatter = frame.rain && !marks.empty() ? std::shared_ptr<const FrameSplatter>(splatter) : nullptr;
  if (loaded_steps_ != steps || loaded_shells_ != shells) {
    for (nlohmann::json& pass : table_["passes"]) {
      if (pass["pass"] == "splatter") pass["parameters"] = {{"shells", shells}, {"least_px", 2.0}};
      if (pass["pass"] == "halos") pass["parameters"] = {{"steps", steps}, {"least_px", 0.01}};  // whole, however far
    }
    if (auto loaded = graph_->load_table(table_, "the stage of splatter"); !loaded) return loaded;
    loaded_steps_ = steps;
    loaded_shells_ = shells;
  }
  finish_frame(frame);
  gpu_.upload(frame);
  auto drawn = graph_->execute(frame, frame.width, frame.height, timer_);
  if (!drawn) return tl::unexpected(drawn.error());
  output_ = *drawn;
  return {};
}

Result<std::vector<double>> SplatterStage::time(std::string_view pass, int frames) {
  std::vector<double> all;
  for (int i = 0; i < frames + 3; ++i) {
    frame.time_s += 1.0 / 60.0;
    timer_.begin_frame(true);
    if (auto drawn = draw(); !drawn) return tl::unexpected(drawn.error());
    timer_.end_frame();
    glFinish();
    for (const Timing& t : timer_.collect())
      if (i >= 3 && t.name == pass) all.push_back(t.milliseconds);
  }
  return all;
}

std::vector<float> SplatterStage::read_distances() const {
  std::vector<float> depth(std::size_t(output_->width) * output_->height);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureImage(depth_, 0, GL_DEPTH_COMPONENT, GL_FLOAT, static_cast<GLsizei>(depth.size() * sizeof(float)),
                    depth.data());
  for (float& d : depth) d = d > 0.0f ? frame.camera.near_m / d : INFINITY;
  return depth;
}

std::vector<glm::vec3> SplatterStage::read_normals() const {
  std::vector<glm::vec4> packed(std::size_t(output_->width) * output_->height);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureImage(normal_, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(packed.size() * sizeof(glm::vec4)),
                    packed.data());
  std::vector<glm::vec3> normals;
  for (const glm::vec4& p : packed) {  // octahedral
    const glm::vec2 at = glm::vec2(p) * 2.0f - 1.0f;
    glm::vec3 n(at, 1.0f - std::abs(at.x) - std::abs(at.y));
    const float t = std::max(-n.z, 0.0f);
    n.x += n.x >= 0.0f ? -t : t;
    n.y += n.y >= 0.0f ? -t : t;
    normals.push_back(glm::normalize(n));
  }
  return normals;
}

std::vector<float> SplatterStage::read_light() const {
  std::vector<float> light(std::size_t(output_->width) * output_->height * 4);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureImage(output_->id, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(light.size() * sizeof(float)),
                    light.data());
  return light;
}

}  // namespace petrichor
