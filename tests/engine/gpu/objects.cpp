#include "engine/gpu/objects.hpp"

#include <vector>

#include "engine/gpu/formats.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

using Objects = test::GlTest;

TEST_F(Objects, BufferHoldsGrowsAndClears) {
  const std::vector<int> values{1, 2, 3, 4};
  Buffer buffer = make_buffer(values.size() * sizeof(int), values.data());
  std::vector<int> back(4);
  read_buffer(buffer, back.data(), 16);
  EXPECT_EQ(back, values);
  read_buffer(buffer, back.data(), 4, 8);
  EXPECT_EQ(back[0], 3);

  const GLuint id = buffer.id;
  const std::vector<int> more{9, 8, 7, 6, 5};
  upload(buffer, std::span<const int>(more));
  EXPECT_EQ(GLuint(buffer.id), id);  // bindings by id stay good
  EXPECT_EQ(buffer.bytes, 32u);      // doubled
  back.resize(5);
  read_buffer(buffer, back.data(), 20);
  EXPECT_EQ(back, more);

  clear_buffer(buffer);
  read_buffer(buffer, back.data(), 20);
  EXPECT_EQ(back, std::vector<int>(5, 0));
}

TEST_F(Objects, UploadMakesABufferFromNothing) {
  Buffer buffer;
  upload(buffer, std::span<const int>());
  EXPECT_NE(GLuint(buffer.id), 0u);
  const float value = 2.5f;
  upload(buffer, &value, sizeof value);
  float back = 0;
  read_buffer(buffer, &back, sizeof back);
  EXPECT_EQ(back, 2.5f);
}

TEST_F(Objects, AMovedFromOwnerOwnsNothing) {
  Texture texture = make_texture_2d(4, 4, GL_RGBA8);
  const GLuint id = texture.id;
  Texture other = std::move(texture);
  EXPECT_EQ(GLuint(texture.id), 0u);
  EXPECT_EQ(GLuint(other.id), id);
  EXPECT_TRUE(glIsTexture(id));
  other = Texture{};
  EXPECT_FALSE(glIsTexture(id));
}

TEST_F(Objects, TexturesHaveTheSizeAndFormatAskedFor) {
  const Texture texture = make_texture_2d(20, 9, GL_RGBA16F, full_mip_levels(20, 9));
  EXPECT_EQ(texture.levels, 5);  // 20 10 5 2 1
  GLint width = 0, format = 0;
  glGetTextureLevelParameteriv(texture.id, 4, GL_TEXTURE_WIDTH, &width);
  glGetTextureLevelParameteriv(texture.id, 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
  EXPECT_EQ(width, 1);
  EXPECT_EQ(format, GL_RGBA16F);
  const Texture array = make_texture_2d_array(8, 8, 3, GL_DEPTH_COMPONENT32F);
  GLint depth = 0;
  glGetTextureLevelParameteriv(array.id, 0, GL_TEXTURE_DEPTH, &depth);
  EXPECT_EQ(depth, 3);
  EXPECT_EQ(make_texture_cube(16, GL_RGBA16F, 2).layers, 6);
}

TEST(MipLevels, CountDownToOnePixel) {
  EXPECT_EQ(full_mip_levels(1, 1), 1);
  EXPECT_EQ(full_mip_levels(2, 1), 2);
  EXPECT_EQ(full_mip_levels(1280, 720), 11);
}

// Every format in the table makes a texture, clears, and (where it says so) takes image stores.
TEST_F(Objects, EveryKnownFormatWorks) {
  for (const FormatInfo& info : known_formats()) {
    const Texture texture = make_texture_2d(4, 4, info.format);
    clear_texture(texture, {1, 1, 1, 1});
    EXPECT_EQ(find_format(info.name), &info);
    EXPECT_EQ(find_format(info.format), &info);
    GLint supported = 0;
    glGetInternalformativ(GL_TEXTURE_2D, info.format, GL_SHADER_IMAGE_STORE, 1, &supported);
    if (info.image) {
      EXPECT_NE(supported, GL_NONE) << info.name;
      glBindImageTexture(0, texture.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, info.format);
    }
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR)) << info.name;
  }
}

// Both ways of clearing, on every driver: the fastest one differs from machine to machine.
class Clearing : public test::GlTest, public ::testing::WithParamInterface<ClearBy> {};

INSTANTIATE_TEST_SUITE_P(Ways, Clearing, ::testing::Values(ClearBy::fastest, ClearBy::command, ClearBy::compute));

TEST_P(Clearing, FillsEveryLevelAndLayer) {
  const Texture texture = make_texture_2d_array(21, 13, 2, GL_R32UI, 2);
  clear_texture(texture, {7, 0, 0, 0}, GetParam());
  for (const int level : {0, 1}) {
    std::vector<GLuint> pixels(level == 0 ? 21 * 13 * 2 : 10 * 6 * 2);
    const auto bytes = static_cast<GLsizei>(pixels.size() * 4);
    glGetTextureImage(texture.id, level, GL_RED_INTEGER, GL_UNSIGNED_INT, bytes, pixels.data());
    EXPECT_EQ(pixels, std::vector<GLuint>(pixels.size(), 7u));
  }
}

TEST_P(Clearing, KnowsTheKindsOfFormat) {
  for (const GLenum format : {GL_RGBA16F, GL_RGBA8, GL_R32I, GL_RGBA16UI, GL_DEPTH_COMPONENT32F, GL_SRGB8_ALPHA8}) {
    const Texture texture = make_texture_2d(19, 3, format);
    clear_texture(texture, {1, 0, 0, 1}, GetParam());
    const FormatInfo* info = find_format(format);
    if (info->integer) {
      std::vector<GLint> pixels(19 * 3);
      glGetTextureImage(texture.id, 0, GL_RED_INTEGER, GL_INT, 19 * 3 * 4, pixels.data());
      EXPECT_EQ(pixels, std::vector<GLint>(19 * 3, 1)) << info->name;
    } else {
      std::vector<float> pixels(19 * 3);
      glGetTextureImage(texture.id, 0, info->depth ? GL_DEPTH_COMPONENT : GL_RED, GL_FLOAT, 19 * 3 * 4, pixels.data());
      EXPECT_EQ(pixels, std::vector<float>(19 * 3, 1.0f)) << info->name;
    }
  }
  const Texture cube = make_texture_cube(8, GL_R16F);
  clear_texture(cube, {2, 0, 0, 0}, GetParam());
  std::vector<float> pixels(8 * 8 * 6);
  glGetTextureImage(cube.id, 0, GL_RED, GL_FLOAT, 8 * 8 * 6 * 4, pixels.data());
  EXPECT_EQ(pixels, std::vector<float>(8 * 8 * 6, 2.0f));
}

TEST_P(Clearing, BuffersWholeAndBindingsAsTheyWere) {
  const std::vector<unsigned char> ones(300'004, 1);
  for (const std::size_t bytes : {4u, 13u, 300'004u}) {
    const Buffer buffer = make_buffer(bytes, ones.data());
    const Buffer other = make_buffer(512, ones.data());
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 7, other.id, 256, 128);
    clear_buffer(buffer, GetParam());
    std::vector<unsigned char> back(bytes, 9);
    read_buffer(buffer, back.data(), bytes);
    EXPECT_EQ(back, std::vector<unsigned char>(bytes, 0));
    GLint bound = 0;
    GLint64 start = 0;
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, 7, &bound);
    glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, 7, &start);
    EXPECT_EQ(GLuint(bound), GLuint(other.id));
    EXPECT_EQ(start, 256);
  }
}

TEST_F(Objects, FramebufferDrawsIntoItsTextures) {
  const Texture a = make_texture_2d(4, 4, GL_RGBA8), b = make_texture_2d(4, 4, GL_R32F);
  const Texture depth = make_texture_2d(4, 4, GL_DEPTH_COMPONENT32F);
  const GLuint colours[] = {a.id, b.id};
  const Framebuffer framebuffer = make_framebuffer(colours, depth.id);
  EXPECT_EQ(glCheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER), GLenum(GL_FRAMEBUFFER_COMPLETE));
  const float value[] = {0.25f, 0, 0, 1};
  glClearNamedFramebufferfv(framebuffer, GL_COLOR, 1, value);
  float back[16];
  glGetTextureImage(b.id, 0, GL_RED, GL_FLOAT, sizeof back, back);
  EXPECT_EQ(back[15], 0.25f);
  const Framebuffer shadow = make_framebuffer({}, depth.id);
  EXPECT_EQ(glCheckNamedFramebufferStatus(shadow, GL_DRAW_FRAMEBUFFER), GLenum(GL_FRAMEBUFFER_COMPLETE));
}

}  // namespace
}  // namespace petrichor
