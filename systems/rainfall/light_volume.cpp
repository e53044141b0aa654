#include "systems/rainfall/light_volume.hpp"

#include "systems/drops/rays.hpp"

namespace petrichor {

void fill_light_volume(PassContext& context, const char* slot) {
  const Texture& volume = context.texture(slot);
  const Program& program = context.program("fill");
  program.use();
  program.set("least_radiance", context.parameter("least_radiance"));
  set_rays(program, view_rays(context.frame.uniforms));
  glBindImageTexture(0, volume.id, 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  glDispatchCompute(static_cast<GLuint>((volume.width + 7) / 8), static_cast<GLuint>((volume.height + 7) / 8),
                    static_cast<GLuint>(volume.layers));
}

PassOffer rain_light_pass(std::shared_ptr<RainOptics> optics) {
  PassOffer offer;
  offer.name = "rain_light";
  offer.meaning = "what lamps give to falling drops, in a coarse volume of the view";
  offer.slots = {{"rain_light", SlotAccess::write}};
  offer.parameters = {{"least_radiance", 0.002}};
  offer.shaders = {{"fill", {{"systems/rainfall/rain_light.comp.glsl"}, {}}}};
  offer.wanted = [](const Frame& frame) {
    return frame.rain && frame.rain->rain_mm_per_hour > 0.0f && frame.uniforms.counts.x > 0;
  };
  offer.execute = [optics](PassContext& context) {
    bind_rain_optics(*optics, context.frame);
    fill_light_volume(context, "rain_light");
  };
  return offer;
}

}  // namespace petrichor
