#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "engine/core/random.hpp"
#include "systems/drops/optics.hpp"
#include "systems/drops/sums.hpp"
#include "systems/splatter/crowns.hpp"
#include "systems/splatter/mist.hpp"
#include "systems/splatter/placed.hpp"
#include "systems/splatter/splatter.hpp"

namespace petrichor {
namespace {

// Pixels across a mean ring at which it fades in, over four more. On the CPU every pixel of a thing's box pays in full:
// only near ones do.
constexpr float least_ring_px = 2.0f, software_ring_px = 5.0f, fade_px = 4.0f;
constexpr std::size_t most_splattering = 6, software_most_splattering = 2, most_misty = 24;
constexpr float mist_tile_m = 0.4f;
constexpr float published_fin_m = 0.12f;

struct SplatterState {
  std::shared_ptr<RainOptics> optics;
  ShapeStore shapes;
  Texture crowns, mist;
  Buffer block, fins;
  VertexArray fin_array;
  std::vector<FinGpu> list;
  bool software = false, known = false;
};
using State = std::shared_ptr<SplatterState>;

bool misty(const Frame& frame) {
  return frame.splatter && !frame.splatter->catchers.empty() && frame.splatter->mist.column() > 0.0f;
}

void know_device(SplatterState& s) {
  if (!s.known) s.software = is_software_gl();
  s.known = true;
}

void bind_block(SplatterState& s, const CatcherGpu& gpu) {
  upload(s.block, &gpu, sizeof gpu);
  glBindBufferRange(GL_UNIFORM_BUFFER, SPLATTER_CATCHER_BINDING, s.block.id, 0, sizeof gpu);
}

const Program& prepare(const SplatterState& s, PassContext& context, const std::string& name) {
  const bool environment = context.has("environment");
  if (environment) context.bind_texture(7, "environment");
  if (context.has("occlusion_map")) context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
  context.bind_texture(0, "depth");
  const Program& program = context.program(environment ? name + "_environment" : name);
  program.use();
  set_ambient(*s.optics, program);
  program.set("use_occlusion", int(context.has("occlusion_map")));
  return program;
}

void dispatch(const Program& program, const PlacedCatcher& p) {
  program.set("first_pixel", p.first_pixel);
  program.set("last_pixel", p.last_pixel);
  const glm::ivec2 size = p.last_pixel - p.first_pixel + 1;
  program.dispatch(size.x, size.y);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);  // boxes may overlap, and the order of things is theirs
}

// Over the picture as it is: premultiplied, as glass is.
void blend_over(PassContext& context, bool depth) {
  static constexpr std::array<std::string_view, 1> colours{"colour"};
  context.bind_framebuffer(colours, depth ? "depth" : "");
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  if (!depth) return;
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GEQUAL);
  glDepthMask(GL_FALSE);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
}

void end_blending() {
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glFrontFace(GL_CCW);
}

// --- splatter ---

void set_time(const Program& program, const Frame& frame, bool software) {
  const double slot = std::floor(frame.time_s / slot_s);
  program.set("slot", static_cast<unsigned>(static_cast<std::int64_t>(slot)));
  program.set("slot_s", static_cast<float>(slot_s));
  program.set("in_slot_s", static_cast<float>(frame.time_s - slot * slot_s));
  program.set("window_s", std::clamp(frame.camera.exposure_s, 1e-3f, static_cast<float>(slot_s)));
  program.set("slots", software ? 2 : 3);
  for (int i = 0; i < 3; ++i) {
    const auto when = static_cast<std::uint32_t>(static_cast<std::int64_t>(slot)) - static_cast<std::uint32_t>(i);
    const glm::vec4 random = random_float4(glm::uvec4(when, 0x5917u, frame.rain->seed, 0u));
    program.set("shifts[" + std::to_string(i) + "]", glm::vec2(random));
  }
}

void make_shell_array(KeptShape& kept) {
  std::vector<glm::vec3> vertices;
  for (std::size_t i = 0; i < kept.shape.positions.size(); ++i) {
    vertices.push_back(kept.shape.positions[i]);
    vertices.push_back(kept.shape.normals[i]);
  }
  upload(kept.vertices, std::span<const glm::vec3>(vertices));
  upload(kept.indices, std::span<const std::uint32_t>(kept.shape.indices));
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  kept.array = VertexArray(id);
  for (GLuint i = 0; i < 2; ++i) {
    glEnableVertexArrayAttrib(id, i);
    glVertexArrayAttribFormat(id, i, 3, GL_FLOAT, GL_FALSE, i * sizeof(glm::vec3));
    glVertexArrayAttribBinding(id, i, 0);
  }
  glVertexArrayVertexBuffer(id, 0, kept.vertices.id, 0, 2 * sizeof(glm::vec3));
  glVertexArrayElementBuffer(id, kept.indices.id);
}

// As printed: the object's surface anew for each shell, blended onto those below.
void draw_shells(SplatterState& s, PassContext& context, const PlacedCatcher& p, float least_px) {
  if (!p.kept->array) make_shell_array(*p.kept);
  const Program& program = prepare(s, context, "shells");
  set_time(program, context.frame, s.software);
  program.set("fade_px", glm::vec2(least_px, least_px + fade_px));
  blend_over(context, true);
  glEnable(GL_CULL_FACE);
  glFrontFace(glm::determinant(glm::mat3(p.relative_from_object)) < 0.0f ? GL_CW : GL_CCW);
  program.set("relative_from_object", p.relative_from_object);
  const int shells = static_cast<int>(p.gpu.shells.x);
  const float thickness = p.gpu.shells.y / static_cast<float>(shells);
  program.set("thickness_m", thickness);
  glBindVertexArray(p.kept->array);
  for (int i = 0; i < shells; ++i) {
    program.set("height_m", (static_cast<float>(i) + 0.5f) * thickness);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(p.kept->shape.indices.size()), GL_UNSIGNED_INT, nullptr);
  }
  end_blending();
}

void draw_splatter(SplatterState& s, PassContext& context) {
  know_device(s);
  const Frame& frame = context.frame;
  const float share = frame.techniques.share(Effect::splatter, SplatterRung::shells);
  const float asked = context.parameter("least_px");
  const float least_px = asked > 0.0f ? asked : s.software ? software_ring_px : least_ring_px;
  const float ring_m = 2.0f * float(SPLATTER_REACH) * 1e-3f * frame.splatter->mist.crown_mm;
  std::vector<PlacedCatcher> placed =
      place_catchers(s.shapes, frame, context.width, context.height, ring_m, least_px, 0.0f,
                     s.software ? 2 : 6, s.software ? software_most_splattering : most_splattering);
  if (placed.empty()) return;
  if (!s.crowns.id) {
    const std::vector<float> table = make_crowns();
    s.crowns = make_texture_2d_array(SPLATTER_RADII, SPLATTER_AGES, SPLATTER_SHELLS, GL_R32F);
    glTextureSubImage3D(s.crowns.id, 0, 0, 0, 0, SPLATTER_RADII, SPLATTER_AGES, SPLATTER_SHELLS, GL_RED, GL_FLOAT,
                        table.data());
    glTextureParameteri(s.crowns.id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(s.crowns.id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  }
  bind_rain_optics(*s.optics, frame);
  glBindTextureUnit(2, s.crowns.id);
  for (PlacedCatcher& p : placed) {
    // All that an impact throws up, in cross-sections of its drop.
    const SplashMist& mist = frame.splatter->mist;
    p.gpu.shells.z *= share * thrown_sections(mist);
    if (const float shells = context.parameter("shells"); shells > 0.0f)
      p.gpu.shells.x = std::min(shells, float(SPLATTER_SHELLS));
    if (!(p.gpu.shells.z > 0.0f) || !(p.gpu.crown.x > 0.0f)) continue;
    bind_block(s, p.gpu);
    if (p.catcher->published) {
      draw_shells(s, context, p, least_px);
      continue;
    }
    const Program& program = prepare(s, context, "splatter");
    set_time(program, frame, s.software);
    program.set("fade_px", glm::vec2(least_px, least_px + fade_px));
    context.bind_texture(1, "normal");
    context.bind_image(0, "colour", GL_READ_WRITE);
    dispatch(program, p);
  }
}

// --- halos ---

void make_mist(SplatterState& s) {
  const std::vector<std::uint8_t> bytes = make_mist_texture();
  s.mist = make_texture_2d(mist_texels, mist_texels, GL_RG8, full_mip_levels(mist_texels, mist_texels));
  glTextureSubImage2D(s.mist.id, 0, 0, 0, mist_texels, mist_texels, GL_RG, GL_UNSIGNED_BYTE, bytes.data());
  glGenerateTextureMipmap(s.mist.id);
  glTextureParameteri(s.mist.id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(s.mist.id, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTextureParameteri(s.mist.id, GL_TEXTURE_WRAP_T, GL_REPEAT);
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  s.fin_array = VertexArray(id);
  for (GLuint i = 0; i < 5; ++i) {
    glEnableVertexArrayAttrib(id, i);
    glVertexArrayAttribFormat(id, i, 4, GL_FLOAT, GL_FALSE, i * sizeof(glm::vec4));
    glVertexArrayAttribBinding(id, i, 0);
  }
  glVertexArrayBindingDivisor(id, 0, 1);
}

void draw_fins(SplatterState& s, PassContext& context, const std::vector<PlacedCatcher>& placed, int steps) {
  if (!s.mist.id) make_mist(s);
  s.list.clear();
  std::vector<std::pair<std::size_t, std::size_t>> ranges;
  for (const PlacedCatcher& p : placed) {
    const std::size_t first = s.list.size();
    append_fins(p, context.frame, steps, s.list);
    ranges.emplace_back(first, s.list.size() - first);
  }
  if (s.list.empty()) return;
  upload(s.fins, std::span<const FinGpu>(s.list));
  glVertexArrayVertexBuffer(s.fin_array, 0, s.fins.id, 0, sizeof(FinGpu));
  blend_over(context, false);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glBindTextureUnit(3, s.mist.id);
  glBindVertexArray(s.fin_array);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (ranges[i].second == 0) continue;
    const PlacedCatcher& p = placed[i];
    bind_block(s, p.gpu);
    const Program& program = prepare(s, context, "fins");
    const double t = context.frame.time_s, tile = mist_tile_m, speed = p.gpu.mist.w;
    program.set("scrolled", glm::vec2(std::fmod(t * speed, tile), std::fmod(0.8 * t * speed, 1.31 * tile)));
    program.set("tile_m", mist_tile_m);
    program.set("length_m", p.catcher->published ? published_fin_m * p.catcher->halo_height : 0.0f);
    glDrawArraysInstancedBaseInstance(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(ranges[i].second),
                                      static_cast<GLuint>(ranges[i].first));
  }
  glBindTextureUnit(3, 0);
  end_blending();
}

void draw_layer(SplatterState& s, PassContext& context, const std::vector<PlacedCatcher>& placed, int steps) {
  for (const PlacedCatcher& p : placed) {
    if (p.gpu.high.w == 0.0f) continue;  // it lies on its side: its map of heights is not the rain's
    KeptShape& kept = *p.kept;
    if (!kept.heights.id) {
      kept.heights = make_texture_2d(catcher_cells, catcher_cells, GL_RG32F);
      std::vector<glm::vec2> cells;
      for (const glm::vec3& cell : kept.shape.heights) cells.emplace_back(cell.x, cell.z);
      glTextureSubImage2D(kept.heights.id, 0, 0, 0, catcher_cells, catcher_cells, GL_RG, GL_FLOAT, cells.data());
    }
    bind_block(s, p.gpu);
    const Program& program = prepare(s, context, "layer");
    glBindTextureUnit(4, kept.heights.id);
    context.bind_image(0, "colour", GL_READ_WRITE);
    program.set("steps", steps);
    dispatch(program, p);
  }
}

void draw_halos(SplatterState& s, PassContext& context) {
  know_device(s);
  const Frame& frame = context.frame;
  const float layer = frame.techniques.share(Effect::halos, HaloRung::layer);
  const float fins = frame.techniques.share(Effect::halos, HaloRung::fins);
  // Four heights of the mist at least three pixels tall; those that are just so are faint, so that none pops.
  float least_px = context.parameter("least_px");
  if (!(least_px > 0.0f)) least_px = s.software ? 4.0f : 2.0f;
  const float feature_m = 4.0f * frame.splatter->mist.height_m;
  std::vector<PlacedCatcher> placed = place_catchers(s.shapes, frame, context.width, context.height, feature_m,
                                                     least_px, 8.0f * frame.splatter->mist.height_m, s.software ? 2 : 8,
                                                     s.software ? most_misty / 3 : most_misty);
  if (placed.empty()) return;
  bind_rain_optics(*s.optics, frame);
  int steps = static_cast<int>(context.parameter("steps"));
  if (steps <= 0) steps = s.software ? 8 : 16;
  for (PlacedCatcher& p : placed)
    p.gpu.mist.x *=
        std::clamp(feature_m * frame.uniforms.lens.z / (least_px * std::max(p.distance_m, 0.01f)) - 1.0f, 0.0f, 1.0f);
  const auto with_share = [&](float share) {
    std::vector<PlacedCatcher> scaled = placed;
    for (PlacedCatcher& p : scaled) p.gpu.mist.x *= share;
    return scaled;
  };
  if (layer > 0.0f) draw_layer(s, context, with_share(layer), steps);
  if (layer > 0.0f && fins > 0.0f) glMemoryBarrier(GL_ALL_BARRIER_BITS);
  if (fins > 0.0f) draw_fins(s, context, with_share(fins), std::max(steps, 16));
}

std::unordered_map<std::string, ShaderKey> both(const std::string& name, const std::vector<std::string>& files) {
  return {{name, {files, {}}}, {name + "_environment", {files, {"ENVIRONMENT"}}}};
}

}  // namespace

std::vector<PassOffer> splatter_passes(const DropPainting& painting) {
  const State state = std::make_shared<SplatterState>();
  state->optics = painting.optics;
  const std::string folder = "systems/splatter/";
  PassOffer splatter;
  splatter.name = "splatter";
  splatter.meaning = "rings that rain splashes up on marked things, on shells over their surface";
  splatter.slots = {{"colour", SlotAccess::modify},
                    {"depth", SlotAccess::read},
                    {"normal", SlotAccess::read},
                    {"occlusion_map", SlotAccess::read, true},
                    {"environment", SlotAccess::read, true}};
  splatter.parameters = {{"shells", 0.0}, {"least_px", 0.0}};
  splatter.shaders = both("splatter", {folder + "splatter.comp.glsl"});
  splatter.shaders.merge(both("shells", {folder + "shells.vert.glsl", folder + "shells.frag.glsl"}));
  splatter.wanted = [state](const Frame& frame) {
    return misty(frame) && frame.techniques.share(Effect::splatter, SplatterRung::shells) > 0.0f &&
           any_catcher_in_view(state->shapes, frame,
                               2.0f * float(SPLATTER_REACH) * 1e-3f * frame.splatter->mist.crown_mm, 0.0f);
  };
  splatter.execute = [state](PassContext& context) { draw_splatter(*state, context); };

  PassOffer halos;
  halos.name = "halos";
  halos.meaning = "mist of splashes over marked things and along their outlines";
  halos.slots = {{"colour", SlotAccess::modify},
                 {"depth", SlotAccess::read},
                 {"occlusion_map", SlotAccess::read, true},
                 {"environment", SlotAccess::read, true}};
  halos.parameters = {{"steps", 0.0}, {"least_px", 0.0}};
  halos.shaders = both("layer", {folder + "mist_layer.comp.glsl"});
  halos.shaders.merge(both("fins", {folder + "fins.vert.glsl", folder + "fins.frag.glsl"}));
  halos.wanted = [state](const Frame& frame) {
    return misty(frame) &&
           (frame.techniques.share(Effect::halos, HaloRung::layer) > 0.0f ||
            frame.techniques.share(Effect::halos, HaloRung::fins) > 0.0f) &&
           any_catcher_in_view(state->shapes, frame, 4.0f * frame.splatter->mist.height_m,
                               8.0f * frame.splatter->mist.height_m);
  };
  halos.execute = [state](PassContext& context) { draw_halos(*state, context); };
  std::vector<PassOffer> offers;
  offers.push_back(std::move(splatter));
  offers.push_back(std::move(halos));
  return offers;
}

}  // namespace petrichor
