#include "systems/rainfall/light_volume.hpp"

namespace petrichor {

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
    const Texture& volume = context.texture("rain_light");
    bind_rain_optics(*optics, context.frame);
    const Program& program = context.program("fill");
    program.use();
    program.set("least_radiance", context.parameter("least_radiance"));
    const FrameUniforms& u = context.frame.uniforms;
    const float tall = u.lens.x, wide = tall * u.lens.y;
    const glm::mat3 to_world = glm::transpose(glm::mat3(u.view));
    program.set("ray_corner", to_world * glm::vec3(-wide, -tall, -1.0f));
    program.set("ray_x", to_world * glm::vec3(2.0f * wide, 0.0f, 0.0f));
    program.set("ray_y", to_world * glm::vec3(0.0f, 2.0f * tall, 0.0f));
    glBindImageTexture(0, volume.id, 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16F);
    glDispatchCompute(static_cast<GLuint>((volume.width + 7) / 8), static_cast<GLuint>((volume.height + 7) / 8),
                      static_cast<GLuint>(volume.layers));
  };
  return offer;
}

}  // namespace petrichor
