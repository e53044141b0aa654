#include "systems/ripple/passes.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "systems/drops/sums.hpp"
#include "systems/ripple/rings.hpp"
#include "systems/ripple/ripple.hpp"
#include "systems/ripple/seeds.hpp"
#include "systems/ripple/waves.hpp"
#include "systems/ripple_frame.hpp"

namespace petrichor {

RippleShares ripple_shares(const Techniques& techniques, bool published) {
  const auto share = [&](RippleRung rung) { return techniques.share(Effect::ripples, rung); };
  RippleShares s;
  const float euler = share(RippleRung::euler), five = share(RippleRung::verlet5);
  s.near = share(RippleRung::near_tile);
  const float nine = share(RippleRung::verlet9) + s.near;
  s.rings = share(RippleRung::rings);
  s.lattice = euler + five + nine;
  s.scheme.nine_share = five + nine > 0.0f ? nine / (five + nine) : 0.0f;
  s.scheme.euler = euler > five + nine;
  s.scheme.quantised = published;
  return s;
}

double peak_wave_number(double deviation_m) {
  return std::sqrt(3.0) / deviation_m;
}

namespace {

struct RipplesGpu {
  bool software = false, known = false;
  RippleWaves waves;
  RippleRings shared_rings, drip_rings;
  Buffer uniforms;
};

void draw_slopes(PassContext& context, const RippleRun& run, const FrameRipples& frame, double cell_m, float strength,
                 bool near, bool add, int level) {
  const Program& program = context.program(near ? "slopes_near" : "slopes");
  const int cells = run.lattice.cells;
  program.use();
  program.set("cells", cells);
  program.set("back", std::clamp(static_cast<float>(double(run.tick) - frame.time_s / frame.step_s), 0.0f, 1.0f));
  program.set("inverse", static_cast<float>(1.0 / (8.0 * cell_m)));
  program.set("fill", static_cast<float>(2.0 * frame.settings.decay_per_s * frame.step_s));
  program.set("strength", strength);
  program.set("add", int(add));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RIPPLE_STATE_BINDING, run.lattice.state.id);
  glBindImageTexture(0, context.texture("ripples").id, level, GL_FALSE, near ? 1 : 0, GL_READ_WRITE, GL_RGBA16F);
  program.dispatch(cells, cells);
}

void draw_ripples(RipplesGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  const FrameRipples& ripples = *frame.ripples;
  const Texture& map = context.texture("ripples");
  const RippleTick* newest = ripples.at(ripples.tick);
  if (!newest) return;
  glTextureParameteri(map.id, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTextureParameteri(map.id, GL_TEXTURE_WRAP_T, GL_REPEAT);
  if (map.levels > 1) glTextureParameteri(map.id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  const RippleSettings& settings = ripples.settings;
  const RippleShares shares = ripple_shares(frame.techniques, settings.published);
  const RipplePrograms programs{&context.program("stamp"), &context.program("step"), &context.program("step_near")};
  // Software OpenGL has smaller lattices: they fill a smaller level of the texture.
  if (!gpu.known) gpu.software = is_software_gl();
  gpu.known = true;
  const int level =
      gpu.software ? std::clamp(static_cast<int>(context.parameter("software_level")), 0, map.levels - 1) : 0;
  const int cells = map.width >> level;
  const double tile_cell_m = settings.tile_m / cells;

  // Layer 0, the tile that all share.
  if (shares.rings > 0.0f) {
    const int most = context.parameter("rings") > 0.0f ? static_cast<int>(context.parameter("rings"))
                     : gpu.software                    ? 48
                                                       : 256;
    gpu.shared_rings.draw(context.program("rings"), map, level, 0, strongest_rings(ripples, most, ring_life_s),
                          {tile_cell_m, settings.tile_m, settings.decay_per_s}, shares.rings * settings.strength);
  }
  if (shares.lattice > 0.0f) {
    if (shares.rings > 0.0f) glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    const RippleRun* run = gpu.waves.bring(programs, ripples, shares.scheme, cells, false);
    draw_slopes(context, *run, ripples, tile_cell_m, shares.lattice * settings.strength, false, shares.rings > 0.0f,
                level);
  }

  // Layers 1 and 2, the tile of the world near the eye. Of drips, too, where there is no near lattice.
  RippleUniforms uniforms{};
  uniforms.tile = {1.0f / settings.tile_m, shares.rings + shares.lattice, 0.0f, static_cast<float>(level)};
  const double deviation = std::max<double>(natural_seed_m, seed_cells(settings, cells) * tile_cell_m);
  uniforms.slopes = {newest->slope_variance * settings.strength * settings.strength,
                     static_cast<float>(peak_wave_number(deviation)), 0.0f, 0.35f};
  const double near_cell = newest->near_cell_m;
  if (near_cell > 0.0) {
    const glm::dvec2 low = glm::dvec2(newest->near_centre - cells / 2) * near_cell;
    const glm::dvec2 eye(frame.camera.position_m.x, frame.camera.position_m.z);
    uniforms.near_place = glm::vec4(glm::vec2(low - eye), static_cast<float>(1.0 / (near_cell * cells)), 0.0f);
    uniforms.slopes.z =
        static_cast<float>(peak_wave_number(std::max<double>(natural_seed_m, seed_cells(settings, cells) * near_cell)));
    if (shares.near > 0.0f && map.layers > 1) {
      if (const RippleRun* run = gpu.waves.bring(programs, ripples, shares.scheme, cells, true)) {
        draw_slopes(context, *run, ripples, near_cell, settings.strength, true, false, level);
        uniforms.near_place.w = shares.near;
      }
    }
    std::vector<RippleRing> drips;
    for (RippleRing ring : ripples.drips) {
      ring.place_m -= low;
      if (ring.place_m.x > -0.5 && ring.place_m.y > -0.5 && ring.place_m.x < near_cell * cells + 0.5 &&
          ring.place_m.y < near_cell * cells + 0.5)
        drips.push_back(ring);
    }
    if (!drips.empty() && map.layers > 2) {
      gpu.drip_rings.draw(context.program("rings"), map, level, 2, drips, {near_cell, 0.0, settings.decay_per_s},
                          uniforms.tile.y * settings.strength);
      uniforms.tile.z = 1.0f;
    }
  }
  upload(gpu.uniforms, &uniforms, sizeof uniforms);
  glBindBufferBase(GL_UNIFORM_BUFFER, RIPPLE_UNIFORMS_BINDING, gpu.uniforms.id);
}

}  // namespace

std::vector<PassOffer> ripple_passes() {
  auto gpu = std::make_shared<RipplesGpu>();
  PassOffer offer;
  offer.name = "ripples";
  offer.meaning =
      "waves on standing water: slopes of a repeated tile, of a tile of the world near the eye, and of drips";
  offer.slots = {{"ripples", SlotAccess::write}};
  // rings: the most that are stamped in closed form; 0: by the device. software_level: how often software OpenGL halves
  // the lattices, as far as the texture has levels.
  offer.parameters = {{"rings", 0.0}, {"software_level", 0.0}};
  const std::string folder = "systems/ripple/";
  offer.shaders = {{"stamp", {{folder + "ripple_stamp.comp.glsl"}, {}}},
                   {"step", {{folder + "ripple_step.comp.glsl"}, {}}},
                   {"step_near", {{folder + "ripple_step.comp.glsl"}, {"NEAR"}}},
                   {"slopes", {{folder + "ripple_slopes.comp.glsl"}, {}}},
                   {"slopes_near", {{folder + "ripple_slopes.comp.glsl"}, {"NEAR"}}},
                   {"rings", {{folder + "ripple_rings.comp.glsl"}, {}}}};
  offer.wanted = [](const Frame& frame) {
    return frame.ripples && frame.ripples->seen && frame.techniques.share(Effect::ripples, RippleRung::none) < 1.0f;
  };
  offer.execute = [gpu](PassContext& context) { draw_ripples(*gpu, context); };
  return {std::move(offer)};
}

}  // namespace petrichor
