// Images, textures and materials.
#include "tests/engine/assets/gltf_builder.hpp"

namespace petrichor::testing_gltf {
namespace {

class Materials : public Assets {
 protected:
  static Builder textured(const std::string& uri) {
    Builder b = Builder::triangle();
    b.root["images"] = {{{"uri", uri}}};
    b.root["textures"] = {{{"source", 0}}};
    b.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    b.primitive()["material"] = 0;
    return b;
  }
  static Builder embedded(const Bytes& image) { return textured("data:image/png;base64," + base64(image)); }

  std::vector<int> texel(const Bytes& image) {
    const Model model = must_load(embedded(image));
    if (model.images.size() != 1 || model.images[0].pixels.size() < 4) return {};
    const auto& p = model.images[0].pixels;
    return {p[0], p[1], p[2], p[3]};
  }

  Bytes encode(const std::string& name, int channels, const std::vector<float>& pixels, int width, int height) {
    return encode_image(folder / name, channels, pixels, width, height);
  }
};

TEST_F(Materials, EveryKindOfPng) {
  EXPECT_EQ(texel(png(1, 1, 8, 6, {0, 10, 20, 30, 40})), (std::vector{10, 20, 30, 40})) << "alpha stays unassociated";
  EXPECT_EQ(texel(png(1, 1, 8, 2, {0, 10, 20, 30})), (std::vector{10, 20, 30, 255}));
  EXPECT_EQ(texel(png(1, 1, 8, 0, {0, 77})), (std::vector{77, 77, 77, 255}));
  EXPECT_EQ(texel(png(1, 1, 8, 4, {0, 77, 20})), (std::vector{77, 77, 77, 20}));
  EXPECT_EQ(texel(png(1, 1, 16, 2, {0, 10, 10, 20, 20, 30, 30})), (std::vector{10, 20, 30, 255}));
  EXPECT_EQ(texel(png(1, 1, 1, 0, {0, 0x80})), (std::vector{255, 255, 255, 255}));
}

TEST_F(Materials, RowsRunFromTheTop) {
  const Model model = must_load(embedded(png(1, 2, 8, 0, {0, 200, 0, 100})));
  EXPECT_EQ(model.images.at(0).height, 2);
  EXPECT_EQ(model.images[0].pixels.at(0), 200);
  EXPECT_EQ(model.images[0].pixels.at(4), 100);
}

TEST_F(Materials, JpegAndFloatImages) {
  const Bytes jpeg = encode("a.jpg", 3, std::vector<float>(16 * 16 * 3, 0.5f), 16, 16);
  const Model from_jpeg = must_load(embedded(jpeg));
  ASSERT_EQ(from_jpeg.images.at(0).pixels.size(), 16u * 16 * 4);
  EXPECT_NEAR(from_jpeg.images[0].pixels[0], 128, 3);
  const Bytes exr = encode("a.exr", 3, {4.0f, 0.5f, 0.25f}, 1, 1);
  const Model from_exr = must_load(embedded(exr));
  ASSERT_TRUE(from_exr.images.at(0).is_float);
  ASSERT_EQ(from_exr.images[0].pixels.size(), 16u);
  float value[4];
  std::memcpy(value, from_exr.images[0].pixels.data(), 16);
  EXPECT_EQ(value[0], 4.0f);
  EXPECT_EQ(value[2], 0.25f);
  EXPECT_EQ(value[3], 1.0f);
}

TEST_F(Materials, OtherFormatsThatAreRead) {
  for (const char* name : {"a.bmp", "a.tif", "a.hdr", "a.webp"}) {
    const Bytes image = encode(name, 3, std::vector<float>(8 * 8 * 3, 1.0f), 8, 8);
    const auto model = load(embedded(image));
    ASSERT_TRUE(model) << name << ": " << model.error().message;
    EXPECT_EQ(model->images.at(0).width, 8) << name;
    if (!model->images[0].is_float) {
      EXPECT_EQ(model->images[0].pixels.at(1), 255) << name;
    }
  }
}

TEST_F(Materials, ImagesInFilesAndViews) {
  const Bytes image = png(1, 1, 8, 2, {0, 1, 2, 3});
  write_file(folder / "brick wall.png", image);
  EXPECT_EQ(must_load(textured("brick%20wall.png")).images.at(0).pixels.at(2), 3);
  Builder b = Builder::triangle();
  b.root["images"] = {{{"bufferView", b.view(image)}, {"mimeType", "image/png"}}};
  EXPECT_EQ(must_load(b).images.at(0).pixels.at(2), 3);
  const auto glb = load_bytes(b.glb());
  ASSERT_TRUE(glb) << glb.error().message;
  EXPECT_EQ(glb->images.at(0).pixels.at(2), 3);
  b.root["images"][0]["uri"] = "x.png";
  must_fail(b, {"/images/0", "either"});
}

TEST_F(Materials, HostileImages) {
  must_fail(embedded({'h', 'e', 'l', 'l', 'o'}), {"/images/0", "no image"});
  must_fail(embedded({}), {"/images/0", "no image"});
  must_fail(embedded(png(100000, 1, 8, 0, Bytes(100001))), {"/images/0", "100000"});
  must_fail(embedded(png(1, 100000, 8, 0, Bytes(200000))), {"/images/0", "100000"});
  must_fail(embedded(png(100000, 100000, 8, 6, {})), {"/images/0", "100000"});
  must_fail(embedded(png(0, 5, 8, 0, {0})), {"/images/0"});
  must_fail(embedded(png(0x7fffffff, 0x7fffffff, 16, 6, {})), {"/images/0"});
  Bytes cut = png(64, 64, 8, 6, plain_rows(256, 64, 7));
  must_load(embedded(cut));
  cut.resize(cut.size() / 2);
  must_fail(embedded(cut), {"/images/0"});
  cut.resize(20);
  must_fail(embedded(cut), {"/images/0"});
  must_fail(textured("gone.png"), {"/images/0/uri", "gone.png"});
  must_fail(textured("../gone.png"), {"/images/0/uri"});
  write_file(folder / "text.png", std::string("no image"));
  must_fail(textured("text.png"), {"/images/0", "text.png", "no image"});
}

TEST_F(Materials, EverythingOfAMaterial) {
  Builder b = embedded(png(1, 1, 8, 2, {0, 1, 2, 3}));
  b.root["extensionsUsed"] = {"KHR_materials_emissive_strength", "KHR_texture_transform", "KHR_materials_unlit"};
  b.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
  b.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  b.root["materials"] = json::parse(R"([{
    "name": "sign",
    "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.25,
      "baseColorTexture": {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform":
        {"offset": [0.5, 0.25], "rotation": 1.5, "scale": [2, 3], "texCoord": 1}}},
      "metallicRoughnessTexture": {"index": 0}},
    "normalTexture": {"index": 0, "scale": 0.75, "texCoord": 1},
    "occlusionTexture": {"index": 0, "strength": 0.6},
    "emissiveTexture": {"index": 0},
    "emissiveFactor": [1, 0.5, 0],
    "alphaMode": "MASK", "alphaCutoff": 0.3, "doubleSided": true,
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 200}, "KHR_materials_unlit": {}},
    "extras": {"wet": 1}}, {}])");
  const Model model = must_load(b);
  const Material& m = model.materials.at(0);
  EXPECT_EQ(m.name, "sign");
  EXPECT_EQ(m.base_colour, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 0.25f);
  EXPECT_EQ(m.emissive, glm::vec3(200, 100, 0));
  EXPECT_EQ(m.normal_scale, 0.75f);
  EXPECT_EQ(m.occlusion_strength, 0.6f);
  EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(m.alpha_cutoff, 0.3f);
  EXPECT_TRUE(m.double_sided);
  EXPECT_TRUE(m.unlit);
  EXPECT_EQ(json::parse(m.extras_json)["wet"], 1);
  const TextureUse& t = m.base_colour_texture;
  EXPECT_EQ(t.image, 0);
  EXPECT_EQ(t.texcoord, 1) << "KHR_texture_transform overrides it";
  EXPECT_EQ(t.wrap_u, Wrap::clamp);
  EXPECT_EQ(t.wrap_v, Wrap::mirror);
  EXPECT_TRUE(t.nearest);
  EXPECT_EQ(t.offset, glm::vec2(0.5f, 0.25f));
  EXPECT_EQ(t.scale, glm::vec2(2, 3));
  EXPECT_EQ(t.rotation_rad, 1.5f);
  EXPECT_EQ(m.normal_texture.texcoord, 1);
  EXPECT_EQ(m.occlusion_texture.image, 0);
  EXPECT_EQ(m.emissive_texture.image, 0);
  EXPECT_EQ(m.metallic_roughness_texture.image, 0);
  const Material plain = model.materials.at(1);  // the defaults of the specification
  EXPECT_EQ(plain.base_colour, glm::vec4(1));
  EXPECT_EQ(plain.metallic, 1.0f);
  EXPECT_EQ(plain.roughness, 1.0f);
  EXPECT_EQ(plain.emissive, glm::vec3(0));
  EXPECT_EQ(plain.alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(plain.base_colour_texture.image, no_index);
  EXPECT_FALSE(plain.unlit);
}

TEST_F(Materials, SpecularGlossinessIsTranslated) {
  Builder b = embedded(png(1, 1, 8, 2, {0, 1, 2, 3}));
  b.root["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
  b.root["materials"] = json::parse(R"([{"extensions": {"KHR_materials_pbrSpecularGlossiness":
    {"diffuseFactor": [0.5, 0.25, 1, 1], "glossinessFactor": 0.75, "diffuseTexture": {"index": 0}}}}])");
  const Material m = must_load(b).materials.at(0);
  EXPECT_EQ(m.base_colour, glm::vec4(0.5f, 0.25f, 1, 1));
  EXPECT_EQ(m.roughness, 0.25f);
  EXPECT_EQ(m.metallic, 0.0f);
  EXPECT_EQ(m.base_colour_texture.image, 0);
}

TEST_F(Materials, OtherFormatsBesidePlainOnes) {
  Builder b = embedded(png(1, 1, 8, 2, {0, 1, 2, 3}));
  b.root["extensionsUsed"] = {"KHR_texture_basisu"};
  b.root["images"].push_back({{"uri", "a.ktx2"}, {"mimeType", "image/ktx2"}});
  b.root["textures"][0]["extensions"] = {{"KHR_texture_basisu", {{"source", 1}}}};
  const Model model = must_load(b);
  EXPECT_EQ(model.materials.at(0).base_colour_texture.image, 0);
  EXPECT_TRUE(warned(model, "KHR_texture_basisu"));
}

TEST_F(Materials, WrongTypes) {
  const auto with = [&](const char* pointer, json value) {
    Builder b = embedded(png(1, 1, 8, 2, {0, 1, 2, 3}));
    b.root[json::json_pointer(pointer)] = std::move(value);
    return load(b);
  };
  must_fail(with("/materials/0/alphaMode", 3), {"/materials/0/alphaMode"});
  must_fail(with("/materials/0/doubleSided", 1), {"/materials/0/doubleSided"});
  must_fail(with("/materials/0/emissiveFactor", {1, 2}), {"/materials/0/emissiveFactor", "2 numbers"});
  must_fail(with("/materials/0/emissiveFactor", {1, 2, "x"}), {"/materials/0/emissiveFactor/2", "\"x\""});
  must_fail(with("/materials/0/pbrMetallicRoughness", "x"), {"/materials/0/pbrMetallicRoughness"});
  must_fail(with("/materials/0/pbrMetallicRoughness/baseColorFactor", {1, 1, 1, 1e300}),
            {"/materials/0/pbrMetallicRoughness/baseColorFactor/3"});
  must_fail(with("/materials/0/pbrMetallicRoughness/metallicFactor", -0.1),
            {"/materials/0/pbrMetallicRoughness/metallicFactor"});
  must_fail(with("/materials/0/pbrMetallicRoughness/baseColorTexture/index", 1),
            {"/materials/0/pbrMetallicRoughness/baseColorTexture/index"});
  must_fail(with("/materials/0/pbrMetallicRoughness/baseColorTexture", json::object()),
            {"baseColorTexture", "\"index\" is missing"});
  must_fail(with("/materials/0/extensions", 1), {"/materials/0/extensions"});
  must_fail(with("/textures/0/source", 5), {"/textures/0/source"});
  must_fail(with("/textures/0/sampler", 0), {"/textures/0/sampler"});
  must_fail(with("/images/0/bufferView", 77), {"/images/0/bufferView"});
  must_fail(with("/images/0/uri", 5), {"/images/0/uri"});
  must_fail(with("/images/0", nullptr), {"/images/0", "null"});
  must_fail(with("/images", 1), {"/images"});
}

}  // namespace
}  // namespace petrichor::testing_gltf
