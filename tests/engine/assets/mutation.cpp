// Valid files with bytes flipped, cut and overwritten: whatever comes, load_model returns, and what it
// returns as a Model keeps the promises of model.hpp. Run under sanitizers by `./dev test --sanitize`.
#include <cmath>

#include "engine/core/random.hpp"
#include "tests/engine/assets/gltf_builder.hpp"

namespace petrichor::testing_gltf {
namespace {

class Mutation : public Assets {
 protected:
  // A little of everything that the loader reads.
  static Builder rich() {
    Builder b = Builder::triangle();
    b.root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_texture_transform", "KHR_materials_emissive_strength"};
    b.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"intensity", 10}, {"spot", {{"outerConeAngle", 0.5}}}}};
    b.primitive()["attributes"]["NORMAL"] = b.data(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, float32, "VEC3", 3);
    b.primitive()["attributes"]["TEXCOORD_0"] =
        b.data(std::vector<std::uint8_t>{0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0}, uint8, "VEC2", 2, true);
    b.root["accessors"].back()["count"] = 3;
    b.root["bufferViews"].back()["byteStride"] = 4;
    b.primitive()["attributes"]["COLOR_0"] = b.data(std::vector<std::uint16_t>(12, 65535), uint16, "VEC4", 4, true);
    b.primitive()["indices"] = b.data(std::vector<std::uint16_t>{0, 1, 2, 0}, uint16, "SCALAR", 1);
    b.primitive()["mode"] = 5;
    const int places = b.view(std::vector<std::uint8_t>{1});
    const int values = b.view(std::vector<float>{0, 0, 2});
    const int delta = b.accessor({{"componentType", float32},
                                  {"type", "VEC3"},
                                  {"count", 3},
                                  {"sparse",
                                   {{"count", 1},
                                    {"indices", {{"bufferView", places}, {"componentType", uint8}}},
                                    {"values", {{"bufferView", values}}}}}});
    b.primitive()["targets"] = {{{"POSITION", delta}}};
    b.root["meshes"][0]["weights"] = {0.5};
    b.root["images"] = {{{"bufferView", b.view(png(4, 4, 8, 6, plain_rows(16, 4, 9)))}, {"mimeType", "image/png"}}};
    b.root["samplers"] = {{{"wrapS", 33071}}};
    b.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
    b.root["materials"] = {
        {{"normalTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {0, 1}}}}}}}},
         {"emissiveFactor", {1, 1, 1}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5}}}}}}};
    b.primitive()["material"] = 0;
    b.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    b.node({{"children", {0, 2}}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}, {"camera", 0}});
    b.node({{"rotation", {0, 0, 0, 1}},
            {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}},
            {"extras", {{"light", {{"casts_shadow", true}}}}}});
    b.primitive()["attributes"]["JOINTS_0"] =
        b.data(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, uint8, "VEC4", 4);
    b.primitive()["attributes"]["WEIGHTS_0"] =
        b.data(std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 128, 127, 0, 0}, uint8, "VEC4", 4, true);
    b.root["skins"] = {{{"joints", {1, 2}}}};
    b.node({{"mesh", 0}, {"skin", 0}});
    b.root["scenes"] = {{{"nodes", {1, 3}}}};
    b.root["scene"] = 0;
    return b;
  }

  static bool finite(const glm::vec4& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
  }

  // The first line of model.hpp.
  static void check_promises(const Model& m) {
    const auto below = [](std::int32_t index, std::size_t size) {
      return index == no_index || (index >= 0 && static_cast<std::size_t>(index) < size);
    };
    for (std::size_t i = 0; i < m.nodes.size(); ++i) {
      const Node& n = m.nodes[i];
      ASSERT_TRUE(n.parent >= no_index && n.parent < static_cast<std::int32_t>(i));
      ASSERT_TRUE(below(n.mesh, m.meshes.size()) && below(n.light, m.lights.size()) &&
                  below(n.camera, m.cameras.size()));
      ASSERT_TRUE(finite(glm::vec4(n.translation_m, 0)) && finite(glm::vec4(n.scale, 0)));
      ASSERT_TRUE(finite({n.rotation.x, n.rotation.y, n.rotation.z, n.rotation.w}));
    }
    for (const Mesh& mesh : m.meshes) {
      for (const Primitive& p : mesh.primitives) {
        ASSERT_TRUE(below(p.material, m.materials.size()));
        ASSERT_EQ(p.indices.size() % 3, 0u);
        for (std::uint32_t i : p.indices) ASSERT_LT(i, p.vertices.size());
        for (const Vertex& v : p.vertices) {
          ASSERT_TRUE(finite(glm::vec4(v.position_m, 0)) && finite(glm::vec4(v.normal, 0)) && finite(v.tangent) &&
                      finite(v.colour) && finite(glm::vec4(v.uv0, v.uv1)));
          ASSERT_NEAR(glm::length(v.normal), 1.0f, 1e-3f);
          ASSERT_NEAR(glm::length(glm::vec3(v.tangent)), 1.0f, 1e-3f);
        }
      }
    }
    for (const Image& image : m.images) {
      ASSERT_EQ(image.pixels.size(), static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                                         (image.is_float ? 16u : 4u));
    }
    for (const Material& material : m.materials) {
      for (const TextureUse* t : {&material.base_colour_texture, &material.metallic_roughness_texture,
                                  &material.normal_texture, &material.occlusion_texture, &material.emissive_texture}) {
        ASSERT_TRUE(below(t->image, m.images.size()) && t->texcoord <= 1);
      }
      ASSERT_TRUE(finite(material.base_colour) && finite(glm::vec4(material.emissive, material.roughness)));
    }
    glm::vec3 low, high;
    if (model_bounds(m, low, high)) {
      ASSERT_TRUE(finite(glm::vec4(low, 0)) && finite(glm::vec4(high, 0)));
    }
  }

  int loaded = 0, refused = 0;

  void attempt(const Bytes& bytes, std::uint32_t round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const auto model = load_bytes(bytes, "mutant.glb");
    if (model) {
      ++loaded;
      check_promises(*model);
    } else {
      ++refused;
      EXPECT_NE(model.error().message.find("mutant.glb"), std::string::npos) << model.error().message;
    }
  }
};

TEST_F(Mutation, TheOriginalIsValid) {
  const auto model = load_bytes(rich().glb());
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->warnings.size(), 1u) << "the skin, which does not move";
  EXPECT_EQ(model->nodes.size(), 5u) << "four, and the root that the posed mesh hangs on";
  check_promises(*model);
}

TEST_F(Mutation, FlippedBytes) {
  const Bytes original = rich().glb();
  RandomStream random(1);
  for (std::uint32_t round = 0; round < 4000; ++round) {
    Bytes bytes = original;
    const std::uint32_t changes = 1 + random.bits() % 4;
    for (std::uint32_t k = 0; k < changes; ++k) {
      const std::uint32_t r = random.bits();
      bytes[random.bits() % bytes.size()] = r & 1
                                                ? static_cast<std::uint8_t>(r >> 8)
                                                : static_cast<std::uint8_t>("0123456789-.eE[]{},\":nul"[(r >> 8) % 24]);
    }
    attempt(bytes, round);
  }
  EXPECT_GT(loaded, 100) << "most of a file is data, where a change need not be an error";
  EXPECT_GT(refused, 100);
}

TEST_F(Mutation, CutsAndDoubledStretches) {
  const Bytes original = rich().glb();
  RandomStream random(2);
  for (std::uint32_t round = 0; round < 1000; ++round) {
    Bytes bytes = original;
    const std::size_t from = random.bits() % bytes.size();
    const std::size_t size = std::min<std::size_t>(random.bits() % 64, bytes.size() - from);
    const auto first = original.begin() + static_cast<std::ptrdiff_t>(from);
    if (round % 3 == 0)
      bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(from),
                  bytes.begin() + static_cast<std::ptrdiff_t>(from + size));
    else if (round % 3 == 1)
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(from), first, first + static_cast<std::ptrdiff_t>(size));
    else
      bytes.resize(from);
    attempt(bytes, round);
  }
}

TEST_F(Mutation, EveryNumberReplaced) {
  // Each number of the JSON in turn by values that break loops, sums and indices.
  const json flat = rich().root.flatten();
  std::uint32_t round = 0;
  for (const auto& [pointer, value] : flat.items()) {
    if (!value.is_number()) continue;
    for (const json& bad : {json(-1), json(0), json(1), json(255), json(2147483647), json(2147483648u),
                            json(4294967295u), json(1e18), json(18446744073709551615ull), json(-9223372036854775807ll),
                            json(1e300), json(0.5), json(nullptr), json("1"), json::array(), json::object()}) {
      Builder b = rich();
      b.root[json::json_pointer(pointer)] = bad;
      attempt(b.glb(), round++);
    }
  }
  EXPECT_GT(round, 1000u);
}

TEST_F(Mutation, EveryMemberGone) {
  const json flat = rich().root.flatten();
  std::uint32_t round = 0;
  for (const auto& [pointer, value] : flat.items()) {
    for (json::json_pointer at(pointer); !at.empty(); at = at.parent_pointer()) {
      Builder b = rich();
      json& parent = b.root[at.parent_pointer()];
      if (parent.is_object())
        parent.erase(at.back());
      else
        parent.erase(std::stoul(at.back()));
      attempt(b.glb(), round++);
    }
  }
}

TEST_F(Mutation, DamagedPictures) {
  RandomStream random(3);
  std::vector<float> pixels(24 * 24 * 4);
  for (float& p : pixels) p = unit_float(random.bits());
  for (const char* name : {"a.png", "a.jpg", "a.webp", "a.bmp", "a.tif", "a.hdr", "a.exr"}) {
    SCOPED_TRACE(name);
    const Bytes original = encode_image(folder / name, 3, pixels, 24, 24);
    ASSERT_FALSE(original.empty());
    for (std::uint32_t round = 0; round < 150; ++round) {
      Bytes image = original;
      // Headers are where the sizes are.
      const std::size_t range = round % 2 ? std::min<std::size_t>(image.size(), 96) : image.size();
      for (std::uint32_t k = 0; k < 1 + round % 3; ++k)
        image[random.bits() % range] = static_cast<std::uint8_t>(random.bits());
      if (round % 8 == 7) image.resize(random.bits() % image.size());
      if (image.empty()) continue;
      Builder b = Builder::triangle();
      b.root["images"] = {{{"bufferView", b.view(image)}}};
      attempt(b.glb(), round);
    }
  }
}

}  // namespace
}  // namespace petrichor::testing_gltf
