#include "systems/drops/composite.hpp"

#include <array>
#include <string>
#include <string_view>

#include "systems/drops/rays.hpp"

namespace petrichor {

void offer_composite(PassOffer& offer, bool snow) {
  offer.slots = {{"colour", SlotAccess::modify}, {"environment", SlotAccess::read, true}};
  for (const bool environment : {false, true}) {
    std::vector<std::string> defines;
    if (snow) defines.emplace_back("SNOW");
    if (environment) defines.emplace_back("ENVIRONMENT");
    const std::string name = environment ? "_environment" : "";
    offer.shaders["composite" + name] = {{"systems/drops/rain_composite.comp.glsl"}, defines};
    defines.emplace_back("SOFTWARE");
    const std::vector<std::string> raster{"systems/drops/rain_composite.vert.glsl",
                                          "systems/drops/rain_composite.frag.glsl"};
    offer.shaders["raster" + name] = {raster, defines};
    defines.emplace_back("LAMPS");
    offer.shaders["raster" + name + "_lamps"] = {raster, defines};
  }
}

void lay_over(RainSums& sums, PassContext& context, const ParticleOptics& optics, float near_extinction) {
  if (sums.width != context.width || sums.height != context.height) return;
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  bind_rain_sums(sums, context.width, context.height);
  const Frame& frame = context.frame;
  // A flash of lightning lights splashes also where there is no lamp.
  const bool lamps = frame.uniforms.counts.x > 0 || (frame.rain && frame.rain->layered.lightning > 0.0f);
  std::string name = sums.software ? "raster" : "composite";
  if (context.has("environment")) name += "_environment";
  if (sums.software && lamps) name += "_lamps";
  const Program& program = context.program(name);
  program.use();
  if (context.has("environment")) context.bind_texture(7, "environment");
  program.set("near_extinction", near_extinction);
  set_ambient(optics, program);
  program.set("lamps", int(lamps));
  set_rays(program, view_rays(context.frame.uniforms, context.width, context.height));
  if (!sums.software) {
    context.bind_image(0, "colour", GL_READ_WRITE);
    program.dispatch(context.width, (context.height + 1) / 2);
    return;
  }
  if (!sums.no_vertices) {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    sums.no_vertices = VertexArray(id);
  }
  static constexpr std::array<std::string_view, 1> colours{"colour"};
  context.bind_framebuffer(colours, "");
  glBindVertexArray(sums.no_vertices);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_ONE, GL_SRC_ALPHA, GL_ZERO, GL_ONE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
  glBindVertexArray(0);
  clear_buffer(sums.optical_depth);
  if (lamps) clear_buffer(sums.radiance);
}

}  // namespace petrichor
