#include "systems/rainfall/layered/passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "systems/rainfall/layered/layered_shared.h"
#include "systems/rainfall/layered/motion.hpp"
#include "systems/rainfall/layered/textures.hpp"

namespace petrichor {
namespace {

static_assert(LAYERED_SHELLS == layered_shells && LAYERED_LEVELS == layered_levels);

struct LayeredGpu {
  std::shared_ptr<RainOptics> optics;
  Texture placement, normals, shell_light, rain;
};

bool wanted(const Frame& frame) {
  return frame.rain && frame.rain->rain_mm_per_hour > 0.0f && frame.rain->share(RainRung::composite) > 0.0f;
}

void make_textures(LayeredGpu& gpu) {
  if (gpu.placement.width) return;
  gpu.placement = make_texture_2d(layered_placement, layered_placement, GL_RGBA8UI);
  const auto placement = make_placement();
  glTextureSubImage2D(gpu.placement.id, 0, 0, 0, layered_placement, layered_placement, GL_RGBA_INTEGER,
                      GL_UNSIGNED_BYTE, placement.data());
  constexpr int size = 64;
  gpu.normals = make_texture_2d_array(size, size, LAYERED_SHAPES, GL_RGBA8_SNORM, full_mip_levels(size, size));
  const auto normals = make_drop_normals(size, LAYERED_SHAPES);
  glTextureSubImage3D(gpu.normals.id, 0, 0, 0, 0, size, size, LAYERED_SHAPES, GL_RGBA, GL_BYTE, normals.data());
  glGenerateTextureMipmap(gpu.normals.id);
  glTextureParameteri(gpu.normals.id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
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

void set_artist(const Program& program, const FrameLayered& layered, float output_scale) {
  program.set("strength", layered.strength);
  program.set("lightning", 1.0f + layered.lightning);
  program.set("milk", layered.milk);
  program.set("milk_cd_m2", 1.0f / output_scale);
}

void set_rays(const Program& program, const PassContext& context) {
  const FrameUniforms& u = context.frame.uniforms;
  const float tall = u.lens.x, wide = tall * u.lens.y;
  const glm::mat3 to_world = glm::transpose(glm::mat3(u.view));
  program.set("ray_corner", to_world * glm::vec3(-wide, -tall, -1.0f));
  program.set("ray_x", to_world * glm::vec3(2.0f * wide / static_cast<float>(context.width), 0.0f, 0.0f));
  program.set("ray_y", to_world * glm::vec3(0.0f, 2.0f * tall / static_cast<float>(context.height), 0.0f));
}

void set_shells(const Program& program, const FrameRain& rain, float pixel_rad) {
  const MeanDrop drop = mean_drop(rain);
  const float share = rain.share(RainRung::composite), extinction = share * rain.drawn_extinction_per_m;
  for (int i = 0; i < layered_shells; ++i) {
    const float from = layered_edges_m[i], to = layered_edges_m[i + 1];
    program.set(indexed("shells", i), glm::vec4(from, to, 1.0f - std::exp(-extinction * (to - from)),
                                                share * static_cast<float>(drop.per_m3) * (to - from)));
    // Two pixels at least; more where near drops are wider than that, and few.
    const double wide = std::max(2.0 * pixel_rad, 2.5 * drop.diameter_m / from);
    program.set(indexed("columns", i), columns_of(i == 0   ? std::max(wide, 8.0 * pixel_rad)
                                                  : i == 1 ? std::max(wide, 4.0 * pixel_rad)
                                                           : wide));
  }
  program.set("drop_m", static_cast<float>(drop.diameter_m));
  program.set("near_depth", extinction);
}

void set_motion(const Program& program, const Frame& frame, float pixel_rad) {
  const FrameLayered& layered = frame.rain->layered;
  const double exposure_s = frame.camera.exposure_s, streak_m = layered.speed_mps * exposure_s;
  program.set("way", layered.turn * glm::vec3(0.0f, -1.0f, 0.0f));
  program.set("side", layered.turn * glm::vec3(1.0f, 0.0f, 0.0f));
  program.set("across", layered.turn * glm::vec3(0.0f, 0.0f, 1.0f));
  program.set("streak_m", static_cast<float>(streak_m));
  const glm::vec3 turned = frame.camera.angular_velocity_radps * static_cast<float>(exposure_s);
  program.set("turned", turned);
  // Cells hold a streak: before that gets tight every other drop fades, and then cells merge by twos.
  constexpr double tight = 0.65, full = 0.85;
  int stretch = 0;
  while (stretch < layered_stretches && streak_m > full * layered_cell_m * (1 << stretch)) ++stretch;
  const double cell_m = layered_cell_m * (1 << stretch), filled = streak_m / cell_m;
  program.set("stretch", stretch);
  program.set("cell_m", static_cast<float>(cell_m));
  program.set("odd_share", static_cast<float>(std::clamp((full - filled) / (full - tight), 0.0, 1.0)));
  for (int level = 0; level < layered_levels; ++level)
    program.set(indexed("travelled", level), static_cast<float>(std::fmod(layered.travelled_m / (cell_m * (1 << level)),
                                                                          double(layered_placement))));
  // Streaks smeared aside by a turning camera need wider columns.
  int turn_level = 0;
  while (turn_level < 2 && glm::length(turned) > 4.0f * pixel_rad * static_cast<float>(1 << (2 * turn_level)))
    ++turn_level;
  program.set("turn_level", turn_level);
}

// Lamplight of the shells' means, for what is too fine to be drawn singly.
void fill_shell_light(LayeredGpu& gpu, PassContext& context) {
  const Texture& volume = context.texture("rain_light");
  if (gpu.shell_light.width != volume.width || gpu.shell_light.height != volume.height)
    gpu.shell_light = make_texture_2d_array(volume.width, volume.height, layered_shells, GL_RGBA16F);
  const Program& program = context.program("shell_light");
  program.use();
  context.bind_texture(14, "rain_light");
  for (int i = 0; i <= layered_shells; ++i) program.set(indexed("edges", i), layered_edges_m[i]);
  glBindImageTexture(0, gpu.shell_light.id, 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  program.dispatch(volume.width, volume.height, layered_shells);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void draw(LayeredGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  make_textures(gpu);
  bind_rain_optics(*gpu.optics, frame);
  const bool scene = context.has("depth"), environment = context.has("environment"),
             lamps = context.has("rain_light") && frame.uniforms.counts.x > 0;
  if (lamps) fill_shell_light(gpu, context);
  std::string name = "layers";
  if (scene) name += "_scene";
  if (environment) name += "_environment";
  if (lamps) name += "_lamps";
  const Program& program = context.program(name);
  program.use();
  const float pixel_rad = 1.0f / frame.uniforms.lens.z;
  set_rain_ambient(*gpu.optics, program);
  set_rays(program, context);
  set_artist(program, frame.rain->layered, frame.uniforms.lens.w);
  set_shells(program, *frame.rain, pixel_rad);
  set_motion(program, frame, pixel_rad);
  program.set("pixel_rad", pixel_rad);
  program.set("salt", frame.rain->seed * 0x9e3779b9u);
  program.set("use_occlusion", int(context.has("occlusion_map")));
  if (scene) context.bind_texture(0, "depth");
  glBindTextureUnit(1, gpu.placement.id);
  if (lamps) glBindTextureUnit(2, gpu.shell_light.id);
  glBindTextureUnit(3, gpu.normals.id);
  if (environment) context.bind_texture(7, "environment");
  if (lamps) context.bind_texture(14, "rain_light");
  if (context.has("occlusion_map")) context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
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
  const std::string folder = "systems/rainfall/layered/";
  for (const bool scene : {false, true})
    for (const bool environment : {false, true})
      for (const bool lamps : {false, true}) {
        std::vector<std::string> defines;
        std::string name = "layers";
        if (scene) defines.push_back("SCENE"), name += "_scene";
        if (environment) defines.push_back("ENVIRONMENT"), name += "_environment";
        if (lamps) defines.push_back("LAMPS"), name += "_lamps";
        offer.shaders[name] = {{folder + "layered_composite.comp.glsl"}, defines};
      }
  offer.shaders["shell_light"] = {{folder + "shell_light.comp.glsl"}, {}};
  offer.wanted = wanted;
  offer.execute = [gpu](PassContext& context) { draw(*gpu, context); };
  return {offer};
}

}  // namespace petrichor
