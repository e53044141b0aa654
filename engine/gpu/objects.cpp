#include "engine/gpu/objects.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

#include "engine/gpu/formats.hpp"

namespace petrichor {

void delete_buffer(GLuint id) {
  glDeleteBuffers(1, &id);
}
void delete_texture(GLuint id) {
  glDeleteTextures(1, &id);
}
void delete_framebuffer(GLuint id) {
  glDeleteFramebuffers(1, &id);
}
void delete_vertex_array(GLuint id) {
  glDeleteVertexArrays(1, &id);
}
void delete_program(GLuint id) {
  glDeleteProgram(id);
}
void delete_sampler(GLuint id) {
  glDeleteSamplers(1, &id);
}

Buffer make_buffer(std::size_t bytes, const void* data) {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  Buffer buffer{GlId<delete_buffer>(id), bytes};
  // Mutable storage, so that upload() may grow it under the same id.
  glNamedBufferData(id, static_cast<GLsizeiptr>(bytes), data, GL_DYNAMIC_DRAW);
  return buffer;
}

void upload(Buffer& buffer, const void* data, std::size_t bytes) {
  if (!buffer.id) buffer = make_buffer(0);
  if (bytes == 0) return;
  if (bytes > buffer.bytes) {
    buffer.bytes = std::max(bytes, 2 * buffer.bytes);
    glNamedBufferData(buffer.id, static_cast<GLsizeiptr>(buffer.bytes), nullptr, GL_DYNAMIC_DRAW);
  }
  glNamedBufferSubData(buffer.id, 0, static_cast<GLsizeiptr>(bytes), data);
}

void read_buffer(const Buffer& buffer, void* data, std::size_t bytes, std::size_t offset) {
  assert(offset + bytes <= buffer.bytes);
  if (bytes == 0) return;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(buffer.id, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

namespace {

Texture create(GLenum target, int width, int height, int layers, GLenum format, int levels) {
  assert(width > 0 && height > 0 && layers > 0 && levels > 0 && levels <= full_mip_levels(width, height));
  GLuint id = 0;
  glCreateTextures(target, 1, &id);
  const FormatInfo* info = find_format(format);
  // Integer textures are incomplete with linear filters; depth is compared, not blended.
  const bool nearest = info && (info->integer || info->depth);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, nearest ? GL_NEAREST : GL_LINEAR);
  const GLint minify = nearest ? (levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST)
                               : (levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, minify);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
    glTextureParameteri(id, axis, GL_CLAMP_TO_EDGE);
  }
  return Texture{GlId<delete_texture>(id), target, format, width, height, layers, levels};
}

}  // namespace

Texture make_texture_2d(int width, int height, GLenum internal_format, int levels) {
  Texture texture = create(GL_TEXTURE_2D, width, height, 1, internal_format, levels);
  glTextureStorage2D(texture.id, levels, internal_format, width, height);
  return texture;
}

Texture make_texture_2d_array(int width, int height, int layers, GLenum internal_format, int levels) {
  Texture texture = create(GL_TEXTURE_2D_ARRAY, width, height, layers, internal_format, levels);
  glTextureStorage3D(texture.id, levels, internal_format, width, height, layers);
  return texture;
}

Texture make_texture_cube(int size, GLenum internal_format, int levels) {
  Texture texture = create(GL_TEXTURE_CUBE_MAP, size, size, 6, internal_format, levels);
  glTextureStorage2D(texture.id, levels, internal_format, size, size);
  return texture;
}

int full_mip_levels(int width, int height) {
  return std::bit_width(static_cast<unsigned>(std::max({width, height, 1})));
}

Framebuffer make_framebuffer(std::span<const GLuint> colour_textures, GLuint depth_texture) {
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  Framebuffer framebuffer(id);
  std::array<GLenum, 8> draw_buffers{};
  assert(colour_textures.size() <= draw_buffers.size());
  for (std::size_t i = 0; i < colour_textures.size(); ++i) {
    const GLenum attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i);
    glNamedFramebufferTexture(id, attachment, colour_textures[i], 0);
    draw_buffers[i] = attachment;
  }
  if (depth_texture) glNamedFramebufferTexture(id, GL_DEPTH_ATTACHMENT, depth_texture, 0);
  if (colour_textures.empty()) {
    glNamedFramebufferDrawBuffer(id, GL_NONE);
    glNamedFramebufferReadBuffer(id, GL_NONE);
  } else {
    glNamedFramebufferDrawBuffers(id, static_cast<GLsizei>(colour_textures.size()), draw_buffers.data());
  }
  assert(glCheckNamedFramebufferStatus(id, GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE);
  return framebuffer;
}

}  // namespace petrichor
