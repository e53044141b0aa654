#include "systems/rainfall/layered/passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "systems/rainfall/layered/layered_shared.h"
#include "systems/rainfall/layered/motion.hpp"
#include "systems/rainfall/layered/textures.hpp"
#include "systems/drops/rays.hpp"
#include "systems/drops/sums.hpp"

namespace petrichor {
namespace {

static_assert(LAYERED_SHELLS == layered_shells && LAYERED_LEVELS == layered_levels);

struct LayeredGpu {
  std::shared_ptr<RainOptics> optics;
  Texture placement, normals, drop_light, haze, open_share, rain;
  int stretch = -1;            // that the placement was made for
  float drop_coverage = 0.5f;  // of a layer of the normal map
};

bool wanted(const Frame& frame) {
  return frame.rain && frame.rain->rain_mm_per_hour > 0.0f && frame.rain->share(RainRung::composite) > 0.0f;
}

void make_textures(LayeredGpu& gpu, int stretch) {
  if (!gpu.normals.width) {
    constexpr int size = 64;
    gpu.normals = make_texture_2d_array(size, size, LAYERED_SHAPES, GL_RGBA8_SNORM, full_mip_levels(size, size));
    const auto normals = make_drop_normals(size, LAYERED_SHAPES);
    glTextureSubImage3D(gpu.normals.id, 0, 0, 0, 0, size, size, LAYERED_SHAPES, GL_RGBA, GL_BYTE, normals.data());
    glGenerateTextureMipmap(gpu.normals.id);
    float covered = 0.0f;
    for (const auto& texel : normals) covered += texel[2] > 0 ? 1.0f : 0.0f;
    gpu.drop_coverage = covered / static_cast<float>(normals.size());
    glTextureParameteri(gpu.normals.id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    gpu.placement = make_texture_2d(layered_placement, layered_placement, GL_RG32UI);
  }
  if (gpu.stretch == stretch) return;
  gpu.stretch = stretch;
  const auto cells = pair_placement(make_placement(), stretch);
  glTextureSubImage2D(gpu.placement.id, 0, 0, 0, layered_placement, layered_placement, GL_RG_INTEGER, GL_UNSIGNED_INT,
                      cells.data());
}

// The drop that stands for all of them: as many and as wide as have the rain's extinction (their D^2) and the deviation
// that it makes (their D^4).
struct MeanDrop {
  double diameter_m = 1e-3, per_m3 = 0.0;
};

MeanDrop mean_drop(const FrameRain& rain) {
  double second = 0.0, fourth = 0.0;
  for (const RainClass& c : rain.classes) {
    if (!c.drawn) continue;
    const double d2 = 1e-6 * double(c.diameter_mm) * c.diameter_mm;
    second += c.drops_per_m3 * d2;
    fourth += c.drops_per_m3 * d2 * d2;
  }
  if (!(second > 0.0)) return {};
  return {std::sqrt(fourth / second), second * second / fourth};
}

// Columns round the way: the most of 1, 1.5 or 2 times a power of two that are not narrower than `least_rad`, so that
// they change seldom while a lens zooms; a multiple of 128, so that they can merge by twos up to seven times.
float columns_of(double least_rad) {
  double count = 128.0;
  const double most = 2.0 * M_PI / least_rad;
  for (double power = 128.0; power <= most && power <= 1 << 20; power *= 2.0) {
    count = power;
    if (power >= 256.0 && 1.5 * power <= most) count = 1.5 * power;
  }
  return static_cast<float>(count);
}

std::string indexed(std::string_view name, int i) {
  return std::string(name) + "[" + std::to_string(i) + "]";
}

void set_artist(const Program& program, const FrameLayered& layered) {
  program.set("strength", layered.strength);
  program.set("lightning", 1.0f + layered.lightning);
  program.set("milk", layered.milk);
}

// How cells lie in this frame.
struct Cells {
  float pixel_rad = 1e-3f;
  glm::vec3 turned{0.0f};  // of the camera while the shutter is open, rad
  bool turning = false;
  int stretch = 0;  // cells are 2^stretch times as tall as layered_cell_m
  double height_m = layered_cell_m, streak_m = 0.0;
  float odd_share = 1.0f;
  MeanDrop drop;
  int shells = layered_shells;
  std::array<float, layered_shells + 1> edges_m = layered_edges_m;
  float columns[layered_shells] = {};
  float opacity[layered_shells] = {};   // of a whole shell
  float contrast[layered_shells] = {};  // share of it in streaks; the rest is haze
  float drops[layered_shells] = {};     // in a cell a metre away, at the equator of the way
  float near_opacity = 0.0f;
};

// shells: 4, or 3, of which the first is then two in one.
Cells cells_of(const Frame& frame, int shells) {
  const FrameRain& rain = *frame.rain;
  const FrameLayered& layered = rain.layered;
  Cells c;
  c.shells = shells;
  if (shells < layered_shells) std::copy(layered_edges_m.begin() + 2, layered_edges_m.end(), c.edges_m.begin() + 1);
  c.pixel_rad = 1.0f / frame.uniforms.lens.z;
  c.turned = frame.camera.angular_velocity_radps * frame.camera.exposure_s;
  c.turning = glm::length(c.turned) > 0.02f * c.pixel_rad;
  c.streak_m = double(layered.speed_mps) * frame.camera.exposure_s;
  // Cells hold a streak: before that gets tight every other drop fades, and then cells merge by twos.
  constexpr double tight = 0.65, full = 0.85;
  while (c.stretch < layered_stretches && c.streak_m > full * c.height_m) ++c.stretch, c.height_m *= 2.0;
  c.odd_share = static_cast<float>(std::clamp((full - c.streak_m / c.height_m) / (full - tight), 0.0, 1.0));
  // Streaks smeared aside by a turning camera need wider columns.
  float wider = 1.0f;
  while (wider < 4.0f && glm::length(c.turned) > 4.0f * c.pixel_rad * wider * wider) wider *= 2.0f;

  c.drop = mean_drop(rain);
  const float share = rain.share(RainRung::composite), extinction = share * rain.drawn_extinction_per_m;
  c.near_opacity = 1.0f - std::exp(-extinction * layered_edges_m[0]);
  for (int i = 0; i < c.shells; ++i) {
    const float from = c.edges_m[i], to = c.edges_m[i + 1];
    c.opacity[i] = 1.0f - std::exp(-extinction * (to - from));
    // Two pixels wide at least; the few near drops need more, where they are wider than that.
    const float pixels = to < 2.0f ? 8.0f : to < 3.0f ? 4.0f : 2.0f;
    c.columns[i] = columns_of(std::max(double(pixels * c.pixel_rad), 2.5 * c.drop.diameter_m / from)) / wider;
    c.drops[i] = static_cast<float>(share * c.drop.per_m3 * (to - from) * c.height_m * 2.0 * M_PI / c.columns[i]);
    // Where a cell has more than one drop, one stands for all with the deviation that they would have. Their optical
    // depths go with 1 / r^2, so the shell's variance is that of one at sqrt(from to); columns are spread evenly in
    // 1 / sqrt(r), and a column's variance goes with the mean of 1 / r. 0.75: the square of the sine of a usual
    // direction.
    const float inverse = (1.0f / from + 1.0f / to + 1.0f / std::sqrt(from * to)) / 3.0f;
    const float expected = c.drops[i] * from * to * inverse * 0.75f;
    c.contrast[i] = std::min(1.0f, std::sqrt(0.5f * (1.0f + c.odd_share) / std::max(expected, 1e-9f)));
  }
  return c;
}

void set_cells(const Program& program, const Frame& frame, const Cells& c) {
  const FrameLayered& layered = frame.rain->layered;
  program.set("way", layered.turn * glm::vec3(0.0f, -1.0f, 0.0f));
  program.set("side", layered.turn * glm::vec3(1.0f, 0.0f, 0.0f));
  program.set("across", layered.turn * glm::vec3(0.0f, 0.0f, 1.0f));
  program.set("streak_cells", static_cast<float>(c.streak_m / c.height_m));
  constexpr double repeats = double(layered_placement) * (1 << (layered_levels - 1));
  program.set("travelled", static_cast<float>(std::fmod(layered.travelled_m / c.height_m, repeats)));
  program.set("per_cell", static_cast<float>(1.0 / c.height_m));
  program.set("odd_share", c.odd_share);
  program.set("stretch", unsigned(c.stretch));
  program.set("pixel_rad", c.pixel_rad);
  program.set("drop_m", static_cast<float>(c.drop.diameter_m));
  program.set("turned", c.turned);
  program.set("salt", frame.rain->seed * 0x9e3779b9u);
  for (int i = 0; i < c.shells; ++i) {
    const float from = c.edges_m[i], to = c.edges_m[i + 1];
    program.set(indexed("shells", i), glm::vec4(from, to - from, c.opacity[i] * c.contrast[i], c.drops[i]));
    program.set(indexed("roots", i), glm::vec2(1.0f / std::sqrt(from), 1.0f / std::sqrt(to)));
    program.set(indexed("columns", i), c.columns[i]);
  }
}

void hold(Texture& texture, int width, int height, int layers, GLenum format) {
  if (texture.width == width && texture.height == height) return;
  texture = layers > 1 ? make_texture_2d_array(width, height, layers, format) : make_texture_2d(width, height, format);
}

// What changes slowly over the picture, on coarse grids: the drops' light, the haze, shelter.
void fill_shells(LayeredGpu& gpu, PassContext& context, const Cells& cells) {
  const Frame& frame = context.frame;
  const bool environment = context.has("environment"), shelter = context.has("occlusion_map"),
             lamps = context.has("rain_light") && frame.uniforms.counts.x > 0;
  const int width = (context.width + 15) / 16, height = (context.height + 15) / 16;
  const auto set_edges = [&](const Program& program) {
    program.set("shell_count", cells.shells);
    for (int i = 0; i <= cells.shells; ++i) program.set(indexed("edges", i), cells.edges_m[i]);
  };
  hold(gpu.drop_light, width, height, layered_shells * LAYERED_PARTS, GL_RGBA16F);
  hold(gpu.haze, width, height, layered_shells + 1, GL_RGBA16F);
  if (shelter) {
    hold(gpu.open_share, (context.width + 7) / 8, (context.height + 7) / 8, 1, GL_RGBA8);
    const Program& program = context.program("shelter");
    program.use();
    set_rays(program, view_rays(frame.uniforms));
    set_edges(program);
    context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
    glBindImageTexture(0, gpu.open_share.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    program.dispatch(gpu.open_share.width, gpu.open_share.height);
  }
  const Program& program = context.program(environment ? "light_environment" : "light");
  program.use();
  set_ambient(*gpu.optics, program);
  set_rays(program, view_rays(frame.uniforms));
  set_edges(program);
  program.set("use_lamps", int(lamps));
  program.set("use_shelter", int(shelter));
  for (int i = 0; i < cells.shells; ++i)
    program.set(indexed("opacities", i), cells.opacity[i] * (1.0f - cells.contrast[i]));
  program.set("near_opacity", cells.near_opacity);
  if (environment) context.bind_texture(7, "environment");
  if (lamps) context.bind_texture(14, "rain_light");
  glBindImageTexture(0, gpu.drop_light.id, 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  glBindImageTexture(1, gpu.haze.id, 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  program.dispatch(width, height);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

// As printed. Its rain is glued to the screen: whatever the camera does, only the direction that it falls in changes.
void draw_published(LayeredGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  const FrameUniforms& u = frame.uniforms;
  const FrameLayered& layered = frame.rain->layered;
  const bool normals = context.has("environment"), scene = context.has("depth");
  hold(gpu.rain, context.width, context.height, 1, GL_RGBA16F);
  // v_r in clip space: of a drop at the middle of the layers' depths.
  constexpr float middle_m = 5.0f;
  const glm::vec3 seen = glm::mat3(u.view) * layered.direction_mps;
  const glm::vec2 clip = glm::vec2(seen.x, seen.y) / (middle_m * u.lens.x);
  const float speed = glm::length(clip);
  const glm::vec2 direction = speed > 1e-6f ? clip / speed : glm::vec2(0.0f, -1.0f);
  const Program& program = context.program(normals ? "published_normals" : "published");
  program.use();
  set_rays(program, view_rays(u, context.width, context.height));
  set_artist(program, layered);
  program.set("use_depth", int(scene));
  program.set("direction", direction);
  program.set("speed", speed);
  program.set("elapsed_s", static_cast<float>(layered.time_s));
  program.set("parallax", layered.parallax);
  // An artist's choices: drops a two-hundredth of the picture's height wide at w = 1, eight times as long.
  program.set("cells", 200.0f);
  program.set("elongation", 8.0f);
  // "The strength": more drops in stronger rain. Their opacity is chosen so that the picture's mean is the rain's in
  // the open; the mean share of a texel that a drop covers is the normal map's.
  const float depth = frame.rain->share(RainRung::composite) * frame.rain->drawn_extinction_per_m * layered.far_m;
  const float present = std::clamp(0.02f * std::sqrt(frame.rain->rain_mm_per_hour), 0.02f, 1.0f);
  program.set("present", present);
  program.set("opacity", (1.0f - std::exp(-depth)) / (present * gpu.drop_coverage));
  if (scene) context.bind_texture(0, "depth");
  glBindTextureUnit(1, gpu.placement.id);
  glBindTextureUnit(2, gpu.drop_light.id);
  glBindTextureUnit(3, gpu.normals.id);
  if (normals) context.bind_texture(7, "environment");
  glBindImageTexture(0, gpu.rain.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  program.dispatch(context.width, context.height);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  const Program& blur = context.program("blur");
  blur.use();
  // By the frame's time, as a scroll that is sampled once a frame must be.
  blur.set("smear", direction * speed * std::min(frame.step_s, 0.25f) * 0.5f * glm::vec2(1.0f / u.lens.y, 1.0f));
  glBindTextureUnit(0, gpu.rain.id);
  context.bind_image(0, "colour", GL_READ_WRITE);
  blur.dispatch(context.width, context.height);
}

void draw(LayeredGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  int shells = static_cast<int>(context.parameter("shells"));
  if (shells != 3 && shells != layered_shells) shells = is_software_gl() ? 3 : layered_shells;
  const Cells cells = cells_of(frame, shells);
  make_textures(gpu, cells.stretch);
  bind_rain_optics(*gpu.optics, frame);
  fill_shells(gpu, context, cells);
  if (frame.rain->layered.published) return draw_published(gpu, context);
  // Drops nearer than a metre show the world in them where they are a pixel wide.
  const bool scene = context.has("depth"),
             normals = context.has("environment") && cells.drop.diameter_m > cells.pixel_rad * layered_edges_m[0];
  std::string name = shells == 3 ? "layers_3" : "layers";
  if (normals) name += "_normals";
  if (cells.turning) name += "_turning";
  const Program& program = context.program(name);
  program.use();
  set_rays(program, view_rays(frame.uniforms, context.width, context.height));
  set_artist(program, frame.rain->layered);
  set_cells(program, frame, cells);
  program.set("use_open_share", int(context.has("occlusion_map")));
  program.set("use_depth", int(scene));
  if (scene) context.bind_texture(0, "depth");
  glBindTextureUnit(1, gpu.placement.id);
  glBindTextureUnit(2, gpu.drop_light.id);
  glBindTextureUnit(3, gpu.normals.id);
  glBindTextureUnit(4, gpu.haze.id);
  if (context.has("occlusion_map")) glBindTextureUnit(5, gpu.open_share.id);
  if (normals) context.bind_texture(7, "environment");
  context.bind_image(0, "colour", GL_READ_WRITE);
  program.dispatch(context.width, context.height);
}

}  // namespace

std::vector<PassOffer> layered_passes(std::shared_ptr<RainOptics> optics) {
  auto gpu = std::make_shared<LayeredGpu>();
  gpu->optics = std::move(optics);
  PassOffer offer;
  offer.name = "layered_composite";
  offer.meaning = "falling rain as layers of drops in one pass over the picture (Tatarchuk and Isidoro 2006)";
  offer.slots = {{"colour", SlotAccess::modify},
                 {"depth", SlotAccess::read, true},
                 {"occlusion_map", SlotAccess::read, true},
                 {"environment", SlotAccess::read, true},
                 {"rain_light", SlotAccess::read, true}};
  // shells: of rain, 3 or 4; 0: by the device.
  offer.parameters = {{"shells", 0.0}};
  const std::string folder = "systems/rainfall/layered/";
  const std::string layers = folder + "layered_composite.comp.glsl", light = folder + "shell_light.comp.glsl";
  for (int bits = 0; bits < 8; ++bits) {
    std::string name = bits & 1 ? "layers_3" : "layers";
    std::vector<std::string> defines;
    if (bits & 1) defines.emplace_back("SHELLS 3");
    if (bits & 2) defines.emplace_back("NORMALS"), name += "_normals";
    if (bits & 4) defines.emplace_back("TURNING"), name += "_turning";
    offer.shaders[name] = {{layers}, defines};
  }
  offer.shaders.insert({{"published", {{folder + "layered_published.comp.glsl"}, {}}},
                        {"published_normals", {{folder + "layered_published.comp.glsl"}, {"NORMALS"}}},
                        {"blur", {{folder + "layered_blur.comp.glsl"}, {}}},
                        {"light", {{light}, {}}},
                        {"light_environment", {{light}, {"ENVIRONMENT"}}}});
  offer.shaders["shelter"] = {{folder + "shell_shelter.comp.glsl"}, {}};
  offer.wanted = wanted;
  offer.execute = [gpu](PassContext& context) { draw(*gpu, context); };
  return {offer};
}

}  // namespace petrichor
