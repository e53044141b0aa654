// Extras of materials, and what the G-buffer's water_mask holds of them.
#include <filesystem>
#include <fstream>

#include "systems/geometry/passes.hpp"
#include "systems/wet_materials.hpp"
#include "tests/engine/platform/gl_test.hpp"
#include "tests/systems/geometry/stage.hpp"

namespace petrichor::test {
namespace {

Model with_extras(const std::string& extras) {
  Model model;
  model.source = "yard.glb";
  Material m = coloured(glm::vec3(0.5f));
  m.name = "cobbles";
  m.extras_json = extras;
  model.materials.push_back(m);
  return model;
}

std::string error_of(const Model& model) {
  const auto read = read_material_water(model);
  return read ? "" : read.error().message;
}

TEST(WetMaterials, WithoutExtrasItWetsByItsRoughness) {
  const auto read = read_material_water(with_extras(""));
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->front().wets);
  EXPECT_EQ(read->front().hollow, Hollow::none);
  EXPECT_EQ(read->front().gpu.ripple.w, -1.0f);
  Model unlit = with_extras("");
  unlit.materials.front().unlit = true;
  EXPECT_FALSE(read_material_water(unlit)->front().wets);
}

TEST(WetMaterials, ReadsWhatTheArtistSays) {
  const auto read = read_material_water(with_extras(
      R"({"water": {"hollow": "vertex_colour", "maximum_depth_mm": 40, "porosity": 0.5, "tint": [1, 0.5, 0.25],
                    "ripple_influence": 0.7, "ripple_scale": 2, "ripple_turn_deg": 90}, "other": 3})"));
  ASSERT_TRUE(read) << read.error().message;
  const MaterialWater& w = read->front();
  EXPECT_EQ(w.hollow, Hollow::vertex_colour);
  EXPECT_FLOAT_EQ(w.gpu.absorption_depth.w, 0.04f);
  EXPECT_NEAR(std::exp(-0.1f * w.gpu.absorption_depth.y), 0.5f, 1e-5f) << "of white, through 100 mm";
  EXPECT_FLOAT_EQ(w.gpu.ripple.x, 0.7f);
  EXPECT_FLOAT_EQ(w.gpu.ripple.y, 2.0f);
  EXPECT_NEAR(w.gpu.ripple.z, 1.5708f, 1e-4f);
  EXPECT_FLOAT_EQ(w.gpu.ripple.w, 0.5f);
  EXPECT_FALSE(read_material_water(with_extras(R"({"water": false})"))->front().wets);
}

TEST(WetMaterials, SaysWhichFileMaterialAndFieldIsWrong) {
  for (const auto& [extras, field] : std::vector<std::pair<std::string, std::string>>{
           {R"({"water": 3})", "extras.water"},
           {R"({"water": {"hollow": "blue"}})", "extras.water.hollow"},
           {R"({"water": {"hollow": "texture"}})", "extras.water.texture"},
           {R"({"water": {"porosity": 2}})", "extras.water.porosity"},
           {R"({"water": {"porosity": "much"}})", "extras.water.porosity"},
           {R"({"water": {"maximum_depth_mm": -1}})", "extras.water.maximum_depth_mm"},
           {R"({"water": {"tint": [1, 2, 3]}})", "extras.water.tint"},
           {R"({"water": {"relief_mm": 5}})", "extras.water.relief_mm"},
           {R"({"water": {"colour": 1}})", "extras.water.colour"}}) {
    const std::string error = error_of(with_extras(extras));
    EXPECT_NE(error.find("yard.glb: /materials/0 (cobbles): " + field), std::string::npos) << extras << ": " << error;
  }
}

TEST(WetMaterials, ATextureThatIsNotThereIsAnErrorOfTheFile) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("petrichor_puddle_" + std::to_string(getpid()) + ".gltf");
  std::ofstream(file) << R"({"asset": {"version": "2.0"},
    "materials": [{"extras": {"water": {"hollow": "texture", "texture": {"index": 7}}}}]})";
  const auto model = load_model(file);
  std::filesystem::remove(file);
  ASSERT_FALSE(model);
  EXPECT_NE(model.error().message.find("/materials/0/extras/water/texture/index"), std::string::npos)
      << model.error().message;
}

class WaterMask : public GlTest {
 protected:
  // Mask and albedo at the middle of a quad that fills the view, its vertex colour 0.6, 1, 1, its TEXCOORD_1.x 0.3.
  std::pair<glm::vec2, glm::vec3> drawn(const Model& given) {
    nlohmann::json table = gbuffer_table();
    table["resources"]["mask"] = {{"format", "rg8"}};
    table["passes"][0]["water_mask"] = "mask";
    table["passes"][1]["water_mask"] = "mask";
    std::vector<std::string> names = gbuffer_names;
    names.push_back("water_mask");
    Stage stage(geometry_passes(), names, table);
    Model model = given;
    Primitive p;
    add_quad(p, {-5, -5, -2}, {10, 0, 0}, {0, 10, 0});
    for (Vertex& v : p.vertices) v.colour = {0.6f, 1, 1, 1}, v.uv1 = {0.3f, 0.0f};
    p.material = 0;
    model.meshes.push_back({"quad", {bound(p)}});
    stage.scene.add(model);
    stage.frame.instances = {placed(0, 0, glm::mat4(1.0f))};
    stage.draw();
    const Pixels& mask = stage.pixels["water_mask"];
    const float* m = mask.at(80, 45);
    const float* a = stage.pixels["albedo"].at(80, 45);
    return {{m[0], m[1]}, {a[0] * a[0], a[1] * a[1], a[2] * a[2]}};
  }
};

TEST_F(WaterMask, PlainMaterialsHoldNothingAndCanGetWet) {
  const auto [mask, albedo] = drawn(with_extras(""));
  EXPECT_EQ(mask.x, 0.0f);
  EXPECT_EQ(std::lround(mask.y * 255.0f), 1);
  EXPECT_NEAR(albedo.r, 0.3f, 0.01f) << "the vertex colour is a tint";
  EXPECT_EQ(drawn(with_extras(R"({"water": false})")).first.y, 0.0f) << "kind 0 never gets wet";
}

TEST_F(WaterMask, RedOfTheVertexColour) {
  const auto [mask, albedo] = drawn(with_extras(R"({"water": {"hollow": "vertex_colour", "maximum_depth_mm": 20}})"));
  EXPECT_NEAR(mask.x, 0.6f, 0.003f);
  EXPECT_NEAR(albedo.r, 0.5f, 0.01f) << "and then it is no tint";
  EXPECT_NEAR(albedo.g, 0.5f, 0.01f);
}

TEST_F(WaterMask, RedOfATexture) {
  Model model = with_extras(R"({"water": {"hollow": "texture", "texture": {"index": 0}, "maximum_depth_mm": 20}})");
  Image image;
  image.width = image.height = 1;
  image.pixels = {102, 9, 9, 255};
  model.images.push_back(image);
  model.materials.front().hollow_texture.image = 0;
  const auto [mask, albedo] = drawn(model);
  EXPECT_NEAR(mask.x, 0.4f, 0.003f);
  EXPECT_NEAR(albedo.r, 0.3f, 0.01f) << "the vertex colour still is a tint";
}

TEST_F(WaterMask, CoordinatesOfTheSecondSetAndReliefThatRisesOutOfThem) {
  EXPECT_NEAR(drawn(with_extras(R"({"water": {"hollow": "texcoord_1", "maximum_depth_mm": 20}})")).first.x, 0.3f,
              0.003f);
  Model model = with_extras(
      R"({"water": {"hollow": "texcoord_1", "maximum_depth_mm": 20, "relief_mm": 10, "relief_mean": 0.5}})");
  Image image;
  image.width = image.height = 1;
  image.pixels = {204, 255, 0, 255};  // 0.8: 3 mm above the mean, 0.15 of the depth
  model.images.push_back(image);
  model.materials.front().metallic_roughness_texture.image = 0;
  EXPECT_NEAR(drawn(model).first.x, 0.3f - 0.15f, 0.004f);
}

}  // namespace
}  // namespace petrichor::test
