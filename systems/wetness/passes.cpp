#include <algorithm>
#include <cmath>
#include <glm/packing.hpp>
#include <memory>
#include <string>

#include "systems/in_view.hpp"
#include "systems/puddle_frame.hpp"
#include "systems/wetness/wetness.hpp"
#include "systems/wetness/wetness_shared.h"
#include "systems/wetness_frame.hpp"

namespace petrichor {
namespace {

constexpr int ripple_unit = 8;

struct Buffers {
  Buffer uniforms, films;
};

bool films_wanted(const Frame& frame) {
  return frame.wetness && frame.techniques.share(Effect::wetness, WetnessRung::none) < 1.0f;
}

bool puddles_wanted(const Frame& frame) {
  return frame.puddles && frame.puddles->any_water;
}

// 0: standing water alone.
int level_of(const Frame& frame) {
  if (!films_wanted(frame)) return 0;
  const auto share = [&](WetnessRung rung) { return frame.techniques.share(Effect::wetness, rung); };
  return share(WetnessRung::flowing) > 0.0f ? 3 : share(WetnessRung::sheltered) > 0.0f ? 2 : 1;
}

enum Knows { nothing, kinds, puddles };  // of the materials

std::string program_name(int level, Knows knows) {
  return "level_" + std::to_string(level) + (knows == puddles ? "_puddles" : knows == kinds ? "_kinds" : "");
}

std::unordered_map<std::string, ShaderKey> shaders() {
  std::unordered_map<std::string, ShaderKey> all;
  for (int level = 0; level <= 3; ++level) {
    for (const Knows knows : {nothing, kinds, puddles}) {
      if (level == 0 && knows != puddles) continue;
      std::vector<std::string> defines{"LEVEL " + std::to_string(level)};
      if (knows != nothing) defines.push_back("MASK");
      if (knows == puddles) defines.push_back("STANDING");
      all[program_name(level, knows)] = {{"systems/wetness/wet_surfaces.comp.glsl"}, defines};
    }
  }
  return all;
}

float wrapped(double metres) {
  return static_cast<float>(metres - FLOW_WRAP_M * std::floor(metres / FLOW_WRAP_M));
}

WetnessGpu uniforms_of(const Frame& frame) {
  WetnessGpu gpu{};
  if (!films_wanted(frame)) return gpu;
  const FrameWetness& wet = *frame.wetness;
  const auto share = [&](WetnessRung rung) { return frame.techniques.share(Effect::wetness, rung); };
  gpu.shares = {share(WetnessRung::everywhere), share(WetnessRung::sheltered), share(WetnessRung::flowing), 0.0f};
  gpu.open_film = {wet.film_mm, wet.soaked, wet.published ? 1.0f : 0.0f, wet.rain_mm_per_hour};
  glm::vec3 level(0.0f);
  if (wet.wind) level = {wet.wind->velocity_mps.x, 0.0f, wet.wind->velocity_mps.z};
  const float speed = glm::length(level);
  gpu.spread = {speed > 0.0f ? level / speed * wet.tilt_spread : glm::vec3(wet.tilt_spread, 0.0f, 0.0f),
                static_cast<float>(wet.remembered)};
  gpu.flown = {wrapped(wet.flown_m.x), wrapped(wet.flown_m.y), 0.0f, 0.0f};
  const glm::dvec3& at = frame.camera.position_m;
  gpu.world_from_camera = {wrapped(at.x), static_cast<float>(at.y), wrapped(at.z), 0.0f};
  return gpu;
}

void wet_surfaces(PassContext& context, Buffers& buffers) {
  const Frame& frame = context.frame;
  const bool mask = context.has("water_mask"), water = context.has("water");
  const bool standing = mask && puddles_wanted(frame) && context.has("puddle_list");
  if (!standing && !films_wanted(frame)) return;
  WetnessGpu uniforms = uniforms_of(frame);
  uniforms.flown.z = standing && context.has("ripples") ? 1.0f : 0.0f;
  uniforms.flown.w = water ? 1.0f : 0.0f;
  upload(buffers.uniforms, &uniforms, sizeof uniforms);
  glBindBufferBase(GL_UNIFORM_BUFFER, WETNESS_UNIFORMS_BINDING, buffers.uniforms.id);
  std::vector<glm::uvec2> films(1, glm::uvec2(0));
  if (films_wanted(frame)) {
    films.clear();
    for (const glm::vec4& f : frame.wetness->films)
      films.emplace_back(glm::packHalf2x16({f.x, f.y}), glm::packHalf2x16({f.z, f.w}));
  }
  upload(buffers.films, std::span<const glm::uvec2>(films));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, WETNESS_FILMS_BINDING, buffers.films.id);
  const Program& program = context.program(program_name(level_of(frame), standing ? puddles : mask ? kinds : nothing));
  program.use();
  context.bind_texture(0, "depth");
  if (mask) context.bind_texture(1, "water_mask");
  if (context.has("ripples")) context.bind_texture(ripple_unit, "ripples");
  if (context.has("occlusion_map")) context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
  context.bind_image(0, "albedo", GL_READ_WRITE);
  context.bind_image(1, "normal", GL_READ_WRITE);
  if (water) context.bind_image(2, "water", GL_WRITE_ONLY);
  program.dispatch((context.width + 1) / 2, (context.height + 1) / 2);  // four pixels each
}

}  // namespace

std::vector<PassOffer> wetness_passes() {
  auto buffers = std::make_shared<Buffers>();
  std::vector<PassOffer> offers;
  offers.push_back({"wet_surfaces",
                    "films of water on surfaces: darker, smoother, flatter, by the rain that reaches them",
                    {{"depth", SlotAccess::read},
                     {"albedo", SlotAccess::modify},
                     {"normal", SlotAccess::modify},
                     {"water_mask", SlotAccess::read, true},
                     {"occlusion_map", SlotAccess::read, true},
                     {"ripples", SlotAccess::read, true},
                     {"puddle_list", SlotAccess::read, true},
                     {"water", SlotAccess::write, true}},
                    {},
                    shaders(),
                    [](const Frame& frame) {
                      return frame.scene && (films_wanted(frame) || puddles_wanted(frame)) &&
                             any_surface_in_view(frame);
                    },
                    [buffers](PassContext& context) { wet_surfaces(context, *buffers); }});
  return offers;
}

}  // namespace petrichor
