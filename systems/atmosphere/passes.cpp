#include "systems/atmosphere/passes.hpp"

#include <memory>
#include <string>

#include "engine/gpu/objects.hpp"
#include "systems/frame.hpp"

namespace petrichor {
namespace {

constexpr int list_tile = 8;           // airlight pixels per side of a list's tile
constexpr float sky_reach_m = 400.0f;  // rays that meet nothing gather light so far
constexpr float mist_height_m = 80.0f;
constexpr float street_height_m = 12.0f;

struct AirlightState {
  Texture lists;
};

bool scatters(const Frame& frame) {
  return frame.mist.extinction_per_m > 0.0f || (frame.rain && frame.rain->rain_mm_per_hour > 0.0f) ||
         (frame.snow && frame.snow->snow_mm_per_hour > 0.0f);
}

PassOffer airlight() {
  auto state = std::make_shared<AirlightState>();
  const std::vector<std::string> files{"systems/atmosphere/airlight.comp.glsl"};
  return {"airlight",
          "lamps glowing in mist and in far rain",
          {{"depth", SlotAccess::read},
           {"light_lists", SlotAccess::read},
           {"shadow_atlas", SlotAccess::read, true},
           {"airlight", SlotAccess::write}},
          {{"threshold", 0.003}, {"forward", 0.8}},  // of a white pixel; mean cosine of the scattering angle
          {{"lists", {{"systems/atmosphere/airlight_lists.comp.glsl"}, {}}},
           {"plain", {files, {}}},
           {"shadows", {files, {"SHADOWS"}}}},
          scatters,
          [state](PassContext& context) {
            const Texture& target = context.texture("airlight");
            const float scale = static_cast<float>(context.width) / static_cast<float>(target.width);
            const int across = (target.width + list_tile - 1) / list_tile,
                      down = (target.height + list_tile - 1) / list_tile;
            if (state->lists.width != across || state->lists.height != down)
              state->lists = make_texture_2d(across, down, GL_RGBA32UI);

            const Program& lists = context.program("lists");
            lists.use();
            lists.set("tiles", glm::ivec2(across, down));
            lists.set("tile_pixels", scale * list_tile);
            lists.set("forward", context.parameter("forward"));
            lists.set("threshold", context.parameter("threshold"));
            glBindImageTexture(0, state->lists.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32UI);
            lists.dispatch(across, down);
            glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);

            const bool shadows = context.has("shadow_atlas");
            const Program& gather = context.program(shadows ? "shadows" : "plain");
            gather.use();
            gather.set("size", glm::ivec2(target.width, target.height));
            gather.set("scale", scale);
            gather.set("forward", context.parameter("forward"));
            gather.set("reach_m", sky_reach_m);
            context.bind_texture(0, "depth");
            glBindTextureUnit(1, state->lists.id);
            if (shadows) context.bind_texture(6, "shadow_atlas");
            context.bind_image(0, "airlight", GL_WRITE_ONLY);
            gather.dispatch(target.width, target.height);
          }};
}

PassOffer atmosphere() {
  const std::vector<std::string> files{"systems/atmosphere/atmosphere.comp.glsl"};
  return {"atmosphere",
          "what mist and far rain take from the picture and add to it",
          {{"colour", SlotAccess::modify},
           {"depth", SlotAccess::read},
           {"airlight", SlotAccess::read, true},
           {"environment", SlotAccess::read, true}},
          {},
          {{"plain", {files, {}}},
           {"airlight", {files, {"AIRLIGHT"}}},
           {"environment", {files, {"ENVIRONMENT"}}},
           {"airlight_environment", {files, {"AIRLIGHT", "ENVIRONMENT"}}}},
          {},
          [](PassContext& context) {
            const bool airlight = context.has("airlight"), environment = context.has("environment");
            const Program& program = context.program(airlight && environment ? "airlight_environment"
                                                     : airlight              ? "airlight"
                                                     : environment           ? "environment"
                                                                             : "plain");
            program.use();
            context.bind_texture(0, "depth");
            if (airlight) {
              const Texture& low = context.texture("airlight");
              context.bind_texture(1, "airlight");
              program.set("airlight_size", glm::vec2(low.width, low.height));
              program.set("airlight_scale", static_cast<float>(context.width) / static_cast<float>(low.width));
            }
            if (environment) context.bind_texture(7, "environment");
            program.set("mist_height_m", mist_height_m);
            program.set("street_height_m", street_height_m);
            program.set("reach_m", sky_reach_m);
            context.bind_image(0, "colour", GL_READ_WRITE);
            program.dispatch(context.width, context.height);
          }};
}

PassOffer sky() {
  return {"sky",
          "the night sky everywhere: a background for frames without surfaces",
          {{"colour", SlotAccess::write}},
          {},
          {{"sky", {{"systems/atmosphere/sky.comp.glsl"}, {}}}},
          {},
          [](PassContext& context) {
            context.program("sky").use();
            context.bind_image(0, "colour", GL_WRITE_ONLY);
            context.program("sky").dispatch(context.width, context.height);
          }};
}

}  // namespace

std::vector<PassOffer> atmosphere_passes() {
  std::vector<PassOffer> offers;
  offers.push_back(sky());
  offers.push_back(airlight());
  offers.push_back(atmosphere());
  return offers;
}

}  // namespace petrichor
