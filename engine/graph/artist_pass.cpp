#include "engine/graph/artist_pass.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <array>

namespace petrichor {
namespace {

bool is_image(GLenum type) {
  return type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY;
}

bool is_sampler(GLenum type) {
  switch (type) {
    case GL_SAMPLER_2D:
    case GL_SAMPLER_2D_ARRAY:
    case GL_SAMPLER_CUBE:
    case GL_SAMPLER_2D_SHADOW:
    case GL_SAMPLER_2D_ARRAY_SHADOW:
    case GL_INT_SAMPLER_2D:
    case GL_INT_SAMPLER_2D_ARRAY:
    case GL_UNSIGNED_INT_SAMPLER_2D:
    case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY:
      return true;
    default:
      return false;
  }
}

void run(const ArtistPass& artist, const std::vector<Slot>& slots, PassContext& pass) {
  const Program& program = pass.program("main");
  int unit = 0;
  for (const std::string& sampler : artist.samplers) {
    if (!program.has_uniform(sampler)) continue;
    program.set(sampler, unit);
    pass.bind_texture(unit++, sampler);
  }
  int image_unit = 0;
  glm::ivec2 size(0);
  for (const Slot& slot : slots) {
    if (slot.access == SlotAccess::read) continue;
    const Texture& texture = pass.texture(slot.name);
    size = glm::max(size, glm::ivec2(texture.width, texture.height));
    if (!program.has_uniform(slot.name)) continue;
    program.set(slot.name, image_unit);
    pass.bind_image(image_unit++, slot.name, slot.access == SlotAccess::write ? GL_WRITE_ONLY : GL_READ_WRITE);
  }
  for (const auto& [name, values] : artist.uniforms) program.set_numbers(name, values);
  program.set_numbers("u_size", std::array<double, 2>{double(size.x), double(size.y)});
  program.dispatch(size.x, size.y);
}

}  // namespace

std::shared_ptr<PassOffer> make_artist_offer(ArtistPass artist) {
  auto offer = std::make_shared<PassOffer>();
  offer->name = artist.id;
  offer->meaning = "a render script's own compute shader";
  offer->shaders["main"] = ShaderKey{{artist.file}, {}};
  // The offer owns the function: a raw pointer back to it cannot dangle, a shared one would never be freed.
  offer->execute = [artist, self = offer.get()](PassContext& pass) { run(artist, self->slots, pass); };
  offer->check = [artist](const Program& program) { return check_artist_program(artist, program); };
  return offer;
}

Result<void> check_artist_program(const ArtistPass& artist, const Program& program) {
  const auto fail = [&](std::string_view name, std::string_view what) {
    return failure(fmt::format("{}: \"{}\" {}", artist.file, name, what));
  };
  const auto warn_unused = [&](std::string_view name) {
    spdlog::warn("{}: pass {}: the shader does not use \"{}\"", artist.file, artist.id, name);
  };
  for (const std::string& name : artist.samplers) {
    const GLenum type = program.uniform_type(name);
    if (!type) {
      warn_unused(name);
    } else if (!is_sampler(type)) {
      return fail(name, "is in read, but the shader declares it as no 2D, array or cube sampler");
    }
  }
  for (const std::string& name : artist.images) {
    const GLenum type = program.uniform_type(name);
    if (!type) {
      warn_unused(name);
    } else if (!is_image(type)) {
      return fail(name, "is in write or modify, but the shader declares it as no image");
    }
  }
  for (const auto& [name, values] : artist.uniforms) {
    if (!program.uniform_type(name)) {
      warn_unused(name);
    } else if (!program.set_numbers(name, values)) {
      return fail(name, fmt::format("is given {} number(s), which does not fit the type in the shader", values.size()));
    }
  }
  return {};
}

}  // namespace petrichor
