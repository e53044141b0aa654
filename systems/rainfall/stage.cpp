#include "systems/rainfall/stage.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "systems/drops/drop_optics.hpp"
#include "systems/rainfall/passes.hpp"
#include "systems/drops/rain_shared.h"
#include "systems/rainfall/snow/flake_optics.hpp"

namespace petrichor {
namespace {

PassOffer backdrop_offer(const StageSet& set) {
  PassOffer offer;
  offer.name = "stage_backdrop";
  offer.meaning = "an even wall";
  offer.slots = {{"colour", SlotAccess::write}, {"depth", SlotAccess::write, true}};
  offer.shaders = {{"backdrop", {{"systems/rainfall/stage_backdrop.comp.glsl"}, {}}}};
  const auto optics = std::make_shared<Buffer>();
  offer.execute = [set, optics](PassContext& context) {
    if (set.wall_hides && context.has("depth")) {
      const float depth = context.frame.camera.near_m / set.wall_distance_m;
      glClearTexImage(context.texture("depth").id, 0, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
    }
    if (set.wall_distance_m == 0.0f || !set.fog) {
      const glm::vec3& wall = set.wall_cd_m2;
      clear_texture(context.texture("colour"), {wall.r, wall.g, wall.b, 1.0f});
      return;
    }
    if (optics->bytes == 0) upload(*optics, std::span<const float>(set.flakes ? make_flake_phase() : make_drop_phase()));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RAIN_OPTICS_BINDING, optics->id);
    const Program& program = context.program("backdrop");
    program.use();
    program.set("wall", set.wall_cd_m2);
    program.set("wall_distance_m", set.wall_distance_m);
    program.set("around", context.frame.sky.horizon_cd_m2);  // drops under an even sky show nothing else
    context.bind_image(0, "colour", GL_WRITE_ONLY);
    program.dispatch(context.width, context.height);
  };
  return offer;
}

// A vertical occlusion map of 128 m about the camera: open, or a roof over half of it.
PassOffer map_offer(const StageSet& set) {
  PassOffer offer;
  offer.name = "stage_map";
  offer.meaning = "an occlusion map";
  offer.slots = {{"occlusion_map", SlotAccess::write}};
  const auto uniforms = std::make_shared<Buffer>();
  offer.execute = [set, uniforms](PassContext& context) {
    constexpr float side = 128.0f, top = 64.0f;
    const Texture& map = context.texture("occlusion_map");
    OcclusionUniforms u{};
    glm::mat4& from_relative = u.map_from_relative[0];
    from_relative = glm::mat4(0.0f);
    from_relative[0][0] = from_relative[2][1] = 1.0f / side;
    from_relative[1][2] = -1.0f;
    from_relative[3] = {0.5f, 0.5f, top, 1.0f};
    u.fall_texel[0] = {0.0f, -1.0f, 0.0f, side / static_cast<float>(map.width)};
    u.size_depth[0] = {static_cast<float>(map.width), side, 0.05f, 1.0f};
    u.counts.x = 1;
    upload(*uniforms, &u, sizeof u);
    glBindBufferBase(GL_UNIFORM_BUFFER, OCCLUSION_UNIFORMS_BINDING, uniforms->id);
    const float roof = set.roof_m > 0.0f ? 1.0f - (top - set.roof_m) / side : 0.0f, open = 0.0f;
    glClearTexImage(map.id, 0, GL_DEPTH_COMPONENT, GL_FLOAT, &open);
    glClearTexSubImage(map.id, 0, 0, 0, 0, map.width / 2, map.height, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &roof);
  };
  return offer;
}

PassOffer present_offer() {
  PassOffer offer;
  offer.name = "stage_present";
  offer.meaning = "linear light to 8 bits";
  offer.slots = {{"colour", SlotAccess::read}, {"picture", SlotAccess::write}};
  offer.shaders = {
      {"present", {{"systems/drops/rain_composite.vert.glsl", "systems/rainfall/stage_present.frag.glsl"}, {}}}};
  const auto vertices = std::make_shared<VertexArray>();
  offer.execute = [vertices](PassContext& context) {
    if (!*vertices) {
      GLuint id = 0;
      glCreateVertexArrays(1, &id);
      *vertices = VertexArray(id);
    }
    static constexpr std::array<std::string_view, 1> pictures{"picture"};
    context.bind_framebuffer(pictures, "");
    context.program("present").use();
    context.bind_texture(0, "colour");
    glBindVertexArray(*vertices);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
  };
  return offer;
}

}  // namespace

Result<std::unique_ptr<RainStage>> RainStage::make(bool software_gl, const StageSet& set) {
  std::unique_ptr<RainStage> stage(new RainStage(software_gl, set));
  if (auto loaded = stage->load(); !loaded) return tl::unexpected(loaded.error());
  return stage;
}

Result<void> RainStage::load() {
  std::vector<PassOffer> offers = rainfall_passes({});
  offers.push_back(backdrop_offer(set_));
  offers.push_back(map_offer(set_));
  offers.push_back(present_offer());
  graph_ = std::make_unique<Graph>(library_, std::move(offers));
  using Json = nlohmann::json;
  Json table;
  table["resources"]["colour"] = {{"format", "rgba16f"}};
  Json backdrop = {{"pass", "stage_backdrop"}, {"colour", "colour"}};
  Json splat = {{"pass", "rain_splat"}};
  if (set_.wall_hides) {
    table["resources"]["depth"] = {{"format", "depth32f"}};
    backdrop["depth"] = "depth";
    splat["depth"] = "depth";
  }
  table["passes"] = Json::array({backdrop});
  if (set_.map) {
    table["resources"]["map"] = {{"format", "depth32f"}, {"width", 1024}, {"height", 1024}, {"layers", 1}};
    table["passes"].push_back({{"pass", "stage_map"}, {"occlusion_map", "map"}});
    splat["occlusion_map"] = "map";
  }
  if (set_.draw_rain) {
    table["resources"]["rain_light"] = {{"format", "rgba16f"}, {"scale", 1.0 / 16.0}, {"layers", 12}};
    table["passes"].push_back({{"pass", "rain_light"}, {"rain_light", "rain_light"}});
    table["passes"].push_back({{"pass", "rain_cells"}, {"parameters", {{"path", set_.path}}}});
    splat["near"] = "near_drops";
    table["resources"]["near_drops"] = table["resources"]["near_environment"] = {{"format", "none"}};
    table["passes"].push_back(splat);
    Json sprites = {{"pass", "rain_sprites"}, {"parameters", {{"path", set_.path}}}};
    for (const char* slot : {"depth", "occlusion_map"})
      if (splat.contains(slot)) sprites[slot] = splat[slot];
    table["passes"].push_back(sprites);
    table["passes"].push_back({{"pass", "rain_composite"}, {"colour", "colour"}});
    Json layered = {{"pass", "layered_composite"}, {"colour", "colour"}, {"rain_light", "rain_light"}};
    if (set_.wall_hides) layered["depth"] = "depth";
    if (set_.map) layered["occlusion_map"] = "map";
    layered["parameters"] = {{"shells", set_.layered_shells}};
    table["passes"].push_back(layered);
    Json cone = {{"pass", "double_cone"}, {"colour", "colour"}, {"rain_light", "rain_light"}};
    for (const char* slot : {"depth", "occlusion_map"})
      if (splat.contains(slot)) cone[slot] = splat[slot];
    table["passes"].push_back(cone);
    Json near = splat;
    near["pass"] = "near_drops";
    near["colour"] = "colour";
    near["near_environment"] = "near_environment";
    table["passes"].push_back({{"pass", "near_environment"},
                               {"near_environment", "near_environment"},
                               {"parameters", {{"face_software", 128}}}});
    table["passes"].push_back(near);
    table["resources"]["snow_light"] = {{"format", "rgba16f"}, {"scale", 1.0 / 16.0}, {"layers", 12}};
    Json snow = {{"pass", "snow_field"}};
    for (const char* slot : {"depth", "occlusion_map"})
      if (splat.contains(slot)) snow[slot] = splat[slot];
    table["passes"].push_back({{"pass", "snow_light"}, {"snow_light", "snow_light"}});
    table["passes"].push_back({{"pass", "snow_cells"}});
    table["passes"].push_back(snow);
    table["passes"].push_back({{"pass", "snow_composite"}, {"colour", "colour"}});
    cone["pass"] = "snow_cone";
    cone.erase("rain_light");
    cone["snow_light"] = "snow_light";
    table["passes"].push_back(cone);
  }
  table["output"] = "colour";
  if (set_.present) {
    table["resources"]["picture"] = {{"format", "rgba8"}};
    table["passes"].push_back({{"pass", "stage_present"}, {"colour", "colour"}, {"picture", "picture"}});
    table["output"] = "picture";
  }
  return graph_->load_table(table, "the bare stage");
}

Result<void> RainStage::draw(Frame& frame) {
  finish_frame(frame);
  frame_gpu_.upload(frame);
  auto output = graph_->execute(frame, frame.width, frame.height, timer_);
  if (!output) return tl::unexpected(output.error());
  output_ = *output;
  return {};
}

std::vector<float> RainStage::read_light() const {
  const Texture* texture = output_;
  std::vector<float> pixels(std::size_t(texture->width) * texture->height * 4);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureImage(texture->id, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(pixels.size() * sizeof(float)),
                    pixels.data());
  return pixels;
}

std::vector<unsigned char> RainStage::read_picture() const {
  std::vector<unsigned char> pixels(std::size_t(output_->width) * output_->height * 4);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureImage(output_->id, 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(pixels.size()), pixels.data());
  return pixels;
}

Frame stage_frame(int width, int height, const glm::dvec3& camera_m) {
  Frame frame;
  frame.width = width;
  frame.height = height;
  frame.camera.position_m = camera_m;
  frame.camera.vertical_fov_rad = glm::radians(60.0f);
  frame.sky.zenith_cd_m2 = frame.sky.horizon_cd_m2 = glm::vec3(0.02f, 0.022f, 0.03f);
  return frame;
}

}  // namespace petrichor
