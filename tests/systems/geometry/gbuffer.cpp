#include <glm/gtc/matrix_transform.hpp>

#include "systems/geometry/passes.hpp"
#include "tests/engine/platform/gl_test.hpp"
#include "tests/systems/geometry/stage.hpp"

namespace petrichor::test {
namespace {

glm::quat looking(glm::vec3 way) {
  return glm::quatLookAt(glm::normalize(way), glm::vec3(0, 1, 0));
}

using Gbuffer = test::GlTest;

// A ground, many boxes (some mirrored), and a wavy sheet that is cut into chunks.
Model town(std::uint32_t seed) {
  Model model;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int i = 0; i < 6; ++i) model.materials.push_back(coloured({unit(random), unit(random), unit(random)}));
  model.materials[2].double_sided = true;
  for (int i = 0; i < 5; ++i) {
    const glm::vec3 high(0.3f + unit(random), 0.3f + 2.0f * unit(random), 0.3f + unit(random));
    model.meshes.push_back({"box", {box(-high, high, i)}});
  }
  Primitive sheet;
  sheet.material = 5;
  const int n = 60;  // 7200 triangles: ten chunks
  for (int z = 0; z <= n; ++z) {
    for (int x = 0; x <= n; ++x) {
      const glm::vec3 at(x - 0.5f * n, 0.4f * std::sin(0.7f * x) * std::cos(0.5f * z), z - 0.5f * n);
      sheet.vertices.push_back({at, {0, 1, 0}, {1, 0, 0, 1}, {}, {}, glm::vec4(unit(random), unit(random), 1, 1)});
    }
  }
  for (int z = 0; z < n; ++z) {
    for (int x = 0; x < n; ++x) {
      const auto a = static_cast<std::uint32_t>(z * (n + 1) + x), b = a + 1, c = a + n + 1, d = c + 1;
      for (const std::uint32_t i : {a, c, b, b, c, d}) sheet.indices.push_back(i);
    }
  }
  model.meshes.push_back({"sheet", {bound(sheet)}});
  return model;
}

std::vector<FrameInstance> crowd(std::uint32_t seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  std::vector<FrameInstance> out{placed(0, 5, glm::mat4(1.0f))};
  for (int i = 0; i < count; ++i) {
    glm::mat4 m = glm::translate(glm::mat4(1.0f), {25 * unit(random), 2 + 2 * unit(random), 25 * unit(random)});
    m = glm::rotate(m, 3 * unit(random), glm::normalize(glm::vec3(unit(random), 1.1f, unit(random))));
    m = glm::scale(m, {i % 3 ? 1.0f : -1.3f, 0.8f, i % 5 ? 0.7f : -0.9f});
    out.push_back(placed(0, static_cast<std::uint32_t>(i % 5), m));
  }
  return out;
}

TEST_F(Gbuffer, PositionFromDepthIsExact) {
  Stage stage(geometry_passes(), gbuffer_names, gbuffer_table());
  Model model;
  model.materials.push_back(coloured({1, 1, 1}));
  Primitive ground;
  ground.material = 0;
  add_quad(ground, {-4000, 0, 4000}, {8000, 0, 0}, {0, 0, -8000});
  model.meshes.push_back({"ground", {bound(ground)}});
  const std::uint32_t index = stage.scene.add(model);
  const auto loaded = stage.shaders.load({{"tests/systems/geometry/positions.comp.glsl"}, {}});
  ASSERT_TRUE(loaded) << loaded.error().message;

  // Near the origin, and 20 km from it, where world coordinates in floats are good to 2 mm only.
  for (const glm::dvec3 far : {glm::dvec3(0.0), glm::dvec3(20000.0, 0.0, -7000.0)}) {
    stage.frame.instances = {placed(index, 0, glm::translate(glm::mat4(1.0f), glm::vec3(far)))};
    stage.frame.camera.position_m = far + glm::dvec3(0.3, 1.7, 0.1);
    stage.frame.camera.orientation = looking({0.3f, -0.25f, -1.0f});
    stage.draw();
    // The probe has run; the G-buffer is still there in its textures, but they are the graph's: draw into our own.
    const Pixels& depth = stage.pixels["depth"];
    Texture own = make_texture_2d(depth.width, depth.height, GL_R32F);
    glTextureSubImage2D(own.id, 0, 0, 0, depth.width, depth.height, GL_RED, GL_FLOAT, depth.values.data());
    Texture positions = make_texture_2d(depth.width, depth.height, GL_RGBA32F);
    glBindTextureUnit(0, own.id);
    glBindImageTexture(0, positions.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
    (*loaded)->use();
    (*loaded)->dispatch(depth.width, depth.height);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    std::vector<glm::vec4> got(static_cast<std::size_t>(depth.width * depth.height));
    glGetTextureImage(positions.id, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(got.size() * 16), got.data());

    const FrameCamera& c = stage.frame.camera;
    const double tangent = std::tan(0.5 * static_cast<double>(c.vertical_fov_rad));
    int hits = 0;
    double worst = 0.0;
    for (int y = 0; y < depth.height; ++y) {
      for (int x = 0; x < depth.width; ++x) {
        const double nx = (x + 0.5) / depth.width * 2 - 1, ny = (y + 0.5) / depth.height * 2 - 1;
        const glm::dvec3 ray =
            glm::dquat(c.orientation) * glm::dvec3(nx * tangent * depth.width / depth.height, ny * tangent, -1.0);
        const glm::vec4 p = got[static_cast<std::size_t>(y * depth.width + x)];
        if (ray.y > -1e-4) {
          EXPECT_EQ(p.w, 0.0f);
          continue;
        }
        const glm::dvec3 truth = ray * (-c.position_m.y / ray.y);
        if (glm::length(truth) > 3000.0) continue;
        ASSERT_EQ(p.w, 1.0f) << x << " " << y;
        ++hits;
        worst = std::max(worst, glm::length(glm::dvec3(p) - truth) / glm::length(truth));
      }
    }
    EXPECT_GT(hits, depth.width * depth.height / 3);
    EXPECT_LT(worst, 1e-4);
  }
}

TEST_F(Gbuffer, InstancingEqualsSeparateDraws) {
  Stage stage(geometry_passes(), gbuffer_names, gbuffer_table());
  const Model model = town(7);
  const std::uint32_t shared = stage.scene.add(model);
  stage.frame.camera.position_m = {3, 4, 28};
  stage.frame.camera.orientation = looking({-0.1f, -0.2f, -1.0f});
  const std::vector<FrameInstance> instances = crowd(3, 80);
  ASSERT_EQ(shared, 0u);
  stage.frame.instances = instances;
  stage.draw();
  const std::map<std::string, Pixels> together = stage.pixels;

  // The same things, each with a mesh of its own.
  Model separate = model;
  separate.meshes.clear();
  for (const FrameInstance& i : instances) separate.meshes.push_back(model.meshes[i.mesh]);
  const std::uint32_t own = stage.scene.add(separate);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    stage.frame.instances[i].model = own;
    stage.frame.instances[i].mesh = static_cast<std::uint32_t>(i);
  }
  stage.draw();
  for (const std::string& name : gbuffer_names) EXPECT_EQ(together.at(name).values, stage.pixels[name].values) << name;
  int covered = 0;
  for (const float d : stage.pixels["depth"].values) covered += d > 0.0f;
  EXPECT_GT(covered, 160 * 90 / 2);
}

TEST_F(Gbuffer, CullingDropsNothingThatIsSeen) {
  Stage stage(geometry_passes(), gbuffer_names, gbuffer_table());
  stage.scene.add(town(11));
  stage.frame.instances = crowd(5, 200);
  const auto program = stage.shaders.load(
      {{"systems/geometry/gbuffer.vert.glsl", "systems/geometry/gbuffer.frag.glsl"}, {"MATERIAL_VARIANT 0"}});
  ASSERT_TRUE(program);
  Texture depth = make_texture_2d(160, 90, GL_DEPTH_COMPONENT32F);
  Texture albedo = make_texture_2d(160, 90, GL_RGBA8);
  const GLuint albedo_id = albedo.id;
  const Framebuffer framebuffer = make_framebuffer({&albedo_id, 1}, depth.id);
  // Every plane of this matrix is (0, 0, 0, 1): nothing is outside.
  glm::mat4 everything(0.0f);
  everything[3][3] = 1.0f;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  std::uint64_t fewest = UINT64_MAX, all = 0;
  for (int i = 0; i < 12; ++i) {
    stage.frame.camera.position_m = {30 * unit(random), 2 + 3 * std::abs(unit(random)), 30 * unit(random)};
    stage.frame.camera.orientation = looking({unit(random), 0.4f * unit(random), unit(random)});
    stage.draw();

    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, 160, 90);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    const float zero[4] = {};
    glClearBufferfv(GL_DEPTH, 0, zero);
    glClearBufferfv(GL_COLOR, 0, zero);
    (*program)->use();
    const std::uint64_t drawn =
        draw_instances(stage.scene, stage.frame, stage.frame.uniforms.view_projection, DrawWhat::opaque);
    glClearBufferfv(GL_DEPTH, 0, zero);
    glClearBufferfv(GL_COLOR, 0, zero);
    all = draw_instances(stage.scene, stage.frame, everything, DrawWhat::opaque);
    glDisable(GL_DEPTH_TEST);
    fewest = std::min(fewest, drawn);
    std::vector<float> d(160 * 90), a(160 * 90 * 4);
    glGetTextureImage(depth.id, 0, GL_DEPTH_COMPONENT, GL_FLOAT, static_cast<GLsizei>(d.size() * 4), d.data());
    glGetTextureImage(albedo.id, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(a.size() * 4), a.data());
    EXPECT_EQ(d, stage.pixels["depth"].values) << "view " << i;
    EXPECT_EQ(a, stage.pixels["albedo"].values) << "view " << i;
  }
  EXPECT_LT(fewest, all / 2);  // and something is culled at all
}

TEST_F(Gbuffer, MirroredInstancesFaceOutwards) {
  Stage stage(geometry_passes(), gbuffer_names, gbuffer_table());
  Model model;
  model.materials.push_back(coloured({0.5f, 0.25f, 0.125f}));
  model.meshes.push_back({"box", {box({-1, -1, -1}, {1, 1, 1}, 0)}});
  stage.scene.add(model);
  stage.frame.camera.position_m = {0, 0, 6};
  for (const glm::vec3 scale : {glm::vec3(1), glm::vec3(-1, 1, 1), glm::vec3(1, -1, -1), glm::vec3(-1, -1, -1)}) {
    stage.frame.instances = {placed(0, 0, glm::scale(glm::mat4(1.0f), scale))};
    stage.draw();
    // The near face, not the far one seen from within: 5 m away, normal towards the camera.
    EXPECT_NEAR(0.05f / stage.pixels["depth"].at(80, 45)[0], 5.0f, 1e-4f);
    const float* n = stage.pixels["normal"].at(80, 45);
    EXPECT_NEAR(n[0], 0.5f, 1e-4f);  // octahedral (0, 0) is +z
    EXPECT_NEAR(n[1], 0.5f, 1e-4f);
    const float* a = stage.pixels["albedo"].at(80, 45);
    EXPECT_NEAR(a[0] * a[0], 0.5f, 0.003f);
    EXPECT_NEAR(a[2] * a[2], 0.125f, 0.002f);
  }
}

// A wall in the z plane from (0,0) to (1,1), with a 2x2 picture: red, green over blue, white (rows from the top).
Model textured_wall(TextureUse use) {
  Model model;
  Image image;
  image.width = image.height = 2;
  image.pixels = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 0};
  model.images.push_back(image);
  Material m = coloured({1, 1, 1});
  use.image = 0;
  use.nearest = true;
  m.base_colour_texture = use;
  model.materials.push_back(m);
  Primitive wall;
  wall.material = 0;
  add_quad(wall, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  model.meshes.push_back({"wall", {bound(wall)}});
  return model;
}

glm::vec3 albedo_at(Stage& stage, float u, float v_up) {
  const float* a = stage.pixels["albedo"].at(static_cast<int>(45 * u) + 58, static_cast<int>(45 * v_up) + 23);
  return {a[0], a[1], a[2]};
}

TEST_F(Gbuffer, TexturesStandUprightAndTransformAsGltfSays) {
  Stage stage(geometry_passes(), gbuffer_names, gbuffer_table());
  const std::uint32_t plain = stage.scene.add(textured_wall({}));
  TextureUse turned;  // the extension's own example: the lower left quadrant
  turned.offset = {0, 1};
  turned.rotation_rad = 1.57079632679f;
  turned.scale = {0.5f, 0.5f};
  const std::uint32_t quadrant = stage.scene.add(textured_wall(turned));
  // The wall fills the middle half of the height.
  stage.frame.camera.vertical_fov_rad = 2.0f * std::atan(1.0f);
  stage.frame.camera.position_m = {0.5, 0.5, 1.0};
  stage.frame.instances = {placed(plain, 0, glm::mat4(1.0f))};
  stage.draw();
  EXPECT_EQ(albedo_at(stage, 0.25f, 0.75f), glm::vec3(1, 0, 0));
  EXPECT_EQ(albedo_at(stage, 0.75f, 0.75f), glm::vec3(0, 1, 0));
  EXPECT_EQ(albedo_at(stage, 0.25f, 0.25f), glm::vec3(0, 0, 1));
  EXPECT_EQ(albedo_at(stage, 0.75f, 0.25f), glm::vec3(1, 1, 1));
  stage.frame.instances = {placed(quadrant, 0, glm::mat4(1.0f))};
  stage.draw();
  for (const float u : {0.25f, 0.75f}) {
    for (const float v : {0.25f, 0.75f}) EXPECT_EQ(albedo_at(stage, u, v), glm::vec3(0, 0, 1)) << u << " " << v;
  }
}

TEST_F(Gbuffer, MaskedTexelsAreHoles) {
  Stage stage(geometry_passes(), gbuffer_names, gbuffer_table());
  Model model = textured_wall({});
  model.materials[0].alpha_mode = AlphaMode::mask;
  stage.scene.add(model);
  stage.frame.camera.vertical_fov_rad = 2.0f * std::atan(1.0f);
  stage.frame.camera.position_m = {0.5, 0.5, 1.0};
  stage.frame.instances = {placed(0, 0, glm::mat4(1.0f))};
  stage.draw();
  EXPECT_GT(stage.pixels["depth"].at(58 + 11, 23 + 11)[0], 0.0f);
  EXPECT_EQ(stage.pixels["depth"].at(58 + 33, 23 + 11)[0], 0.0f);  // the white texel's alpha is 0
}

TEST_F(Gbuffer, HostileNormalsAndTangentsGiveNumbers) {
  Stage stage(geometry_passes(), gbuffer_names, gbuffer_table());
  Model model = textured_wall({});
  model.materials[0].normal_texture = model.materials[0].base_colour_texture;
  for (Vertex& v : model.meshes[0].primitives[0].vertices) {
    v.normal = glm::vec3(0.0f);
    v.tangent = glm::vec4(0.0f);
    v.uv0 = glm::vec2(0.0f);
  }
  stage.scene.add(model);
  stage.frame.camera.vertical_fov_rad = 2.0f * std::atan(1.0f);
  stage.frame.camera.position_m = {0.5, 0.5, 1.0};
  // A flattened instance has no inverse.
  stage.frame.instances = {placed(0, 0, glm::scale(glm::mat4(1.0f), {1, 1, 0}))};
  stage.draw();
  EXPECT_GT(stage.pixels["depth"].at(80, 45)[0], 0.0f);
  for (const std::string& name : gbuffer_names) {
    for (const float v : stage.pixels[name].values) ASSERT_TRUE(std::isfinite(v)) << name;
  }
}

}  // namespace
}  // namespace petrichor::test
