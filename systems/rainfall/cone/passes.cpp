#include "systems/rainfall/cone/passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "systems/rainfall/cone/cone.hpp"
#include "systems/rainfall/cone/textures.hpp"
#include "systems/drops/rays.hpp"
#include "systems/rainfall/snow/flake_optics.hpp"
#include "systems/drops/sums.hpp"

namespace petrichor {
namespace {

struct ConeTextureGpu {
  Texture texture;
  std::array<std::vector<std::array<float, cone_channels>>, cone_layers> mean;  // by layer and level
  double full_per_m3 = 0.0;
};

struct ConeGpu {
  std::shared_ptr<RainOptics> rain_optics;
  ParticleOptics flake_optics;
  std::array<std::optional<ConeTextureGpu>, 5> textures;  // by ConeTexture, made when first asked for
};

// What the two passes draw, in the same words.
struct Precipitation {
  FrameCone cone;
  float share, extinction_per_m, mm_per_hour, particles_per_m3, reach_m;
  bool snow;
  const char* light_slot;
};

Precipitation of_rain(const FrameRain& r) {
  float count = 0.0f;
  for (const RainClass& c : r.classes)
    if (c.drawn) count += c.drops_per_m3;
  return {r.cone,
          r.share(RainRung::double_cone),
          r.drawn_extinction_per_m,
          r.rain_mm_per_hour,
          count,
          r.cone.far_m,
          false,
          "rain_light"};
}

Precipitation of_snow(const FrameSnow& s) {
  float count = 0.0f;
  for (const SnowClass& c : s.classes) count += c.flakes_per_m3;
  return {
      s.cone,      s.share(SnowRung::double_cone), s.extinction_per_m, s.snow_mm_per_hour, count, s.cone.far_m, true,
      "snow_light"};
}

const ConeTextureGpu& texture_of(ConeGpu& gpu, ConeTexture kind) {
  auto& found = gpu.textures[static_cast<std::size_t>(kind)];
  if (found) return *found;
  found.emplace();
  const auto made = shared_cone_textures(kind);
  const ConeTextureSet& set = made.get();
  found->full_per_m3 = set.full_per_m3;
  found->texture =
      make_texture_2d_array(cone_texture_size, cone_texture_size, cone_layers, GL_RGBA8, cone_texture_levels);
  const GLuint id = found->texture.id;
  for (int i = 0; i < cone_layers; ++i) {
    found->mean[i] = set.tiles[i].mean;
    for (int level = 0; level < cone_texture_levels; ++level)
      glTextureSubImage3D(id, level, 0, 0, i, cone_texture_size >> level, cone_texture_size >> level, 1, GL_RGBA,
                          GL_UNSIGNED_BYTE, set.tiles[i].levels[level].data());
  }
  glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_REPEAT);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  return *found;
}

std::string indexed(const char* name, int i) {
  return std::string(name) + "[" + std::to_string(i) + "]";
}

// Weights of a texel's channels whose sum is opacity relative to its mean. The number of streaks decides between which
// channels: fewer streaks, each of more opacity, in light rain and where a short exposure draws them short.
glm::vec4 channel_weights(const ConeTextureGpu& texture, int layer, float level_of_detail, double per_m3) {
  const double place =
      std::clamp(std::log(std::max(per_m3, 1e-3) / texture.full_per_m3) / std::log(4.0) + cone_channels - 1.0, 0.0,
                 cone_channels - 1.0);
  const int lower = std::min(static_cast<int>(place), cone_channels - 2);
  const auto upper_share = static_cast<float>(place - lower);
  const int level = std::min(static_cast<int>(level_of_detail), cone_texture_levels - 2);
  const float finer = static_cast<float>(level) + 1.0f - level_of_detail;
  const auto mean = [&](int channel) {
    return (finer * texture.mean[layer][level][channel] + (1.0f - finer) * texture.mean[layer][level + 1][channel]) /
           255.0f;
  };
  glm::vec4 weights(0.0f);
  weights[lower] = (1.0f - upper_share) / std::max(mean(lower), 1e-6f);
  weights[lower + 1] = upper_share / std::max(mean(lower + 1), 1e-6f);
  return weights;
}

void set_layers(ConeGpu& gpu, const PassContext& context, const Program& program, const Precipitation& p) {
  const Frame& frame = context.frame;
  const FrameCone& cone = p.cone;
  const ConeKinds kinds = cone_kinds(cone.texture, p.mm_per_hour, p.snow);
  const ConeTextureGpu& first = texture_of(gpu, kinds.first);
  const ConeTextureGpu& second = texture_of(gpu, kinds.second);
  const bool flakes = cone_particles(kinds.first).flakes;
  glBindTextureUnit(1, first.texture.id);
  glBindTextureUnit(2, second.texture.id);
  glm::vec4 detail, tiles, shear, along, phase, shell_from, shell_middle, shell_to, nearer_slice, farther_slice;

  // One level of detail a layer: that of the middle of the picture.
  const float pixel_rad = 1.0f / frame.uniforms.lens.z;
  const glm::vec3 forward = -glm::vec3(glm::transpose(frame.uniforms.view)[2]);
  const float cosine = glm::dot(forward, cone.axis);
  const float sine = std::max(std::sqrt(std::max(1.0f - cosine * cosine, 0.0f)), 0.35f);
  const float extinction = p.share * p.extinction_per_m;
  const bool software = is_software_gl();
  const auto slices = static_cast<float>(context.has(p.light_slot) ? context.texture(p.light_slot).layers : 1);
  for (int i = 0; i < cone_layers; ++i) {
    const ConeLayer& l = cone_layout(flakes)[i];
    // Farther by cone.farther, a layer has that many times as many tiles around, rounded.
    const float radius = static_cast<float>(l.radius_m) * cone.farther[i], tile = static_cast<float>(l.tile_m);
    const double tiles_around = std::max(1.0, std::round(l.tiles_around * double(cone.farther[i])));
    const auto around = static_cast<float>(tiles_around / (2.0 * M_PI));
    const float texel_u = sine / (around * cone_texture_size);
    const float texel_v = sine * tile * cone.elongation[i] / (radius * cone_texture_size);
    // A level finer than filters would have it: blurred streaks would deviate half as much as rain does, and what
    // twinkles is rain.
    float lod = std::max(std::log2(pixel_rad / texel_u), std::log2(pixel_rad / texel_v) - 1.0f) - 1.0f;
    lod = std::clamp(lod, 0.0f, cone_texture_levels - 1.01f);
    // Between two levels software OpenGL reads twice as many texels.
    if (software) lod = std::round(lod);
    tiles[i] = around;
    shear[i] = around * cone.shear_rad_per_m * radius;
    along[i] = radius / (tile * cone.elongation[i]);
    phase[i] = cone.phase[i];
    detail[i] = lod;
    // Published: as many streaks as the texture has of that rain, however far they are drawn out.
    const double count = p.particles_per_m3 * (cone.published ? 1.0 : double(cone.elongation[i]));
    program.set(indexed("first_weights", i), channel_weights(first, i, lod, count) * (1.0f - kinds.second_share));
    program.set(indexed("second_weights", i), channel_weights(second, i, lod, count) * kinds.second_share);
    const auto from = static_cast<float>(l.from_m), to = std::min(static_cast<float>(l.to_m), p.reach_m);
    const float middle = std::sqrt(from * static_cast<float>(l.to_m));
    shell_from[i] = from;
    shell_middle[i] = std::min(middle, std::max(to, from));
    shell_to[i] = std::max(to, from);
    const auto slice = [&](float a, float b) {  // of light_volume.glsl, that holds the middle of a to b
      const float s = std::log(std::sqrt(a * b) / 0.5f) / std::log(64.0f / 0.5f) * slices - 0.5f;
      return std::clamp(std::floor(s + 0.5f), 0.0f, slices - 1.0f);
    };
    nearer_slice[i] = slice(from, middle);
    farther_slice[i] = slice(middle, static_cast<float>(l.to_m));
  }
  program.set("detail", detail);
  program.set("tiles", tiles);
  program.set("shear", shear);
  program.set("along", along);
  program.set("phase", phase);
  program.set("shell_from", shell_from);
  program.set("shell_middle", shell_middle);
  program.set("shell_to", shell_to);
  program.set("nearer_slice", nearer_slice);
  program.set("farther_slice", farther_slice);
  program.set("extinction", extinction);
  if (p.snow) {
    // Waves so long that flakes next to each other do not change places: the textures would fold.
    const FrameSnow& snow = *frame.snow;
    glm::vec4 jitter, waves;
    for (int i = 0; i < cone_layers; ++i) {
      const float radius = static_cast<float>(cone_layout(flakes)[i].radius_m) * cone.farther[i];
      jitter[i] = cone.published ? 0.0f : snow.cone_jitter_m * tiles[i] / radius;
      waves[i] = std::max(1.0f, std::floor(0.08f / std::max(jitter[i], 1e-3f)));
    }
    program.set("jitter", jitter);
    program.set("jitter_waves", waves);
    // 70/64 and 115/64 Hz, within the sway's 0.5 to 3: the clock wraps at 64 s without a jump.
    const glm::vec2 turns = snow.clock_s * glm::vec2(70.0f, 115.0f) / static_cast<float>(snow_clock_s);
    program.set("jitter_turns", turns - glm::floor(turns));
  }
  program.set("cone", glm::vec3(static_cast<float>(cone_slope), cone.apex_fade, cone.published ? 1.0f : 0.0f));
}

void draw(ConeGpu& gpu, PassContext& context, const Precipitation& p) {
  const Frame& frame = context.frame;
  if (p.snow)
    bind_flake_optics(gpu.flake_optics, frame);
  else
    bind_rain_optics(*gpu.rain_optics, frame);
  const bool scene = context.has("depth"), map = scene && context.has("occlusion_map"),
             environment = context.has("environment"), lamps = context.has(p.light_slot) && frame.uniforms.counts.x > 0;
  std::string name = "cone";
  if (scene) name += "_scene";
  if (environment) name += "_environment";
  if (lamps) name += "_lamps";
  if (cone_kinds(p.cone.texture, p.mm_per_hour, p.snow).second_share > 0.0f) name += "_two_sets";
  const Program& program = context.program(name);
  program.use();
  set_ambient(p.snow ? gpu.flake_optics : *gpu.rain_optics, program);
  set_layers(gpu, context, program, p);
  program.set("use_occlusion", int(map));
  program.set("fall", p.snow ? frame.snow->mean_velocity_mps : frame.rain->mean_velocity_mps);
  const ViewRays rays = view_rays(frame.uniforms, context.width, context.height);
  set_rays(program, rays);
  // The same in the cone's own frame: x and y across its axis, z along it.
  const glm::mat3 to_cone = glm::transpose(glm::mat3(p.cone.side, glm::cross(p.cone.axis, p.cone.side), p.cone.axis));
  program.set("cone_corner", to_cone * rays.corner);
  program.set("cone_x", to_cone * rays.right);
  program.set("cone_y", to_cone * rays.up);
  if (scene) context.bind_texture(0, "depth");
  if (map) context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
  if (environment) context.bind_texture(7, "environment");
  if (lamps) context.bind_texture(14, p.light_slot);
  context.bind_image(0, "colour", GL_READ_WRITE);
  constexpr int rows = 8;  // ROWS of the shader
  program.dispatch(context.width, (context.height + rows - 1) / rows);
}

PassOffer offer_of(std::shared_ptr<ConeGpu> gpu, bool snow) {
  PassOffer offer;
  offer.name = snow ? "snow_cone" : "double_cone";
  offer.meaning = snow ? "falling snow as four textures on a double cone about the camera"
                       : "falling rain as four textures on a double cone about the camera (Wang and Wade 2004)";
  offer.slots = {{"colour", SlotAccess::modify},
                 {"depth", SlotAccess::read, true},
                 {"occlusion_map", SlotAccess::read, true},
                 {"environment", SlotAccess::read, true},
                 {snow ? "snow_light" : "rain_light", SlotAccess::read, true}};
  for (int variant = 0; variant < 16; ++variant) {
    const bool scene = variant & 1, environment = variant & 2, lamps = variant & 4, two_sets = variant & 8;
    ShaderKey key{{"systems/rainfall/cone/double_cone.comp.glsl"}, {}};
    std::string name = "cone";
    if (snow) key.defines.push_back("SNOW");
    if (scene) name += "_scene", key.defines.push_back("SCENE");
    if (environment) name += "_environment", key.defines.push_back("ENVIRONMENT");
    if (lamps) name += "_lamps", key.defines.push_back("LAMPS");
    if (two_sets) name += "_two_sets", key.defines.push_back("TWO_SETS");
    offer.shaders[name] = std::move(key);
  }
  if (snow) {
    offer.wanted = [](const Frame& frame) {
      return frame.snow && frame.snow->snow_mm_per_hour > 0.0f && frame.snow->share(SnowRung::double_cone) > 0.0f;
    };
    offer.execute = [gpu](PassContext& context) { draw(*gpu, context, of_snow(*context.frame.snow)); };
  } else {
    offer.wanted = [](const Frame& frame) {
      return frame.rain && frame.rain->rain_mm_per_hour > 0.0f && frame.rain->share(RainRung::double_cone) > 0.0f;
    };
    offer.execute = [gpu](PassContext& context) { draw(*gpu, context, of_rain(*context.frame.rain)); };
  }
  return offer;
}

}  // namespace

std::vector<PassOffer> cone_passes(std::shared_ptr<RainOptics> optics) {
  auto gpu = std::make_shared<ConeGpu>();
  gpu->rain_optics = std::move(optics);
  return {offer_of(gpu, false), offer_of(gpu, true)};
}

}  // namespace petrichor
