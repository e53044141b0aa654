// Accessors and primitives: what the specification allows, and numbers that lead astray.
#include <cmath>
#include <limits>

#include "tests/engine/assets/gltf_builder.hpp"

namespace petrichor::testing_gltf {
namespace {

class Geometry : public Assets {};

const Primitive& only_primitive(const Model& model) {
  return model.meshes.at(0).primitives.at(0);
}

glm::vec3 corner(const Primitive& p, std::size_t i) {
  return p.vertices.at(p.indices.at(i)).position_m;
}

const std::vector<float> square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

TEST_F(Geometry, FlatNormalsWithoutNormals) {
  Builder b;
  // Two triangles that share an edge at a right angle: flat shading must not share vertices.
  const int position = b.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  const int indices = b.data(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, uint16, "SCALAR", 1);
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}})}});
  const Model model = must_load(b);
  const Primitive& p = only_primitive(model);
  ASSERT_EQ(p.indices.size(), 6u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(p.vertices[p.indices[i]].normal, glm::vec3(0, 0, 1));
  for (std::size_t i = 3; i < 6; ++i) EXPECT_EQ(p.vertices[p.indices[i]].normal, glm::vec3(1, 0, 0));
}

TEST_F(Geometry, EveryIndexType) {
  for (int type : {uint8, uint16, uint32}) {
    Builder b;
    const int position = b.positions(square);
    int indices = 0;
    if (type == uint8) indices = b.data(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, type, "SCALAR", 1);
    if (type == uint16) indices = b.data(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, type, "SCALAR", 1);
    if (type == uint32) indices = b.data(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, type, "SCALAR", 1);
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}})}});
    const Model model = must_load(b);
    ASSERT_EQ(only_primitive(model).indices.size(), 6u) << type;
    EXPECT_EQ(corner(only_primitive(model), 5), glm::vec3(0, 1, 0)) << type;
  }
}

TEST_F(Geometry, StripsAndFansKeepTheirWinding) {
  // The same square as a strip (0 1 3 2) and as a fan (0 1 2 3); all normals must point to +z.
  for (auto [mode, order] :
       {std::pair{5, std::vector<std::uint8_t>{0, 1, 3, 2}}, std::pair{6, std::vector<std::uint8_t>{0, 1, 2, 3}}}) {
    Builder b;
    const int position = b.positions(square);
    const int indices = b.data(order, uint8, "SCALAR", 1);
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}, {"mode", mode}})}});
    const Model model = must_load(b);
    const Primitive& p = only_primitive(model);
    ASSERT_EQ(p.indices.size(), 6u);
    double area = 0.0;
    for (std::size_t i = 0; i < 6; i += 3) {
      const glm::vec3 n = glm::cross(corner(p, i + 1) - corner(p, i), corner(p, i + 2) - corner(p, i));
      EXPECT_GT(n.z, 0.0f) << "mode " << mode;
      area += 0.5 * n.z;
    }
    EXPECT_NEAR(area, 1.0, 1e-6);
  }
}

TEST_F(Geometry, PointsAndLinesAreLeftOutWithAWarning) {
  for (int mode : {0, 1, 2, 3}) {
    Builder b = Builder::triangle();
    b.primitive()["mode"] = mode;
    const Model model = must_load(b);
    EXPECT_TRUE(model.meshes.at(0).primitives.empty());
    EXPECT_TRUE(warned(model, "/meshes/0/primitives/0/mode"));
  }
  Builder b = Builder::triangle();
  b.primitive()["mode"] = 7;
  must_fail(b, {"/meshes/0/primitives/0/mode"});
}

TEST_F(Geometry, Interleaved) {
  Builder b;
  struct Item {
    float position[3];
    float normal[3];
    std::uint16_t uv[2];
    std::uint8_t colour[4];
  };
  static_assert(sizeof(Item) == 32);
  const std::vector<Item> items{{{0, 0, 0}, {0, 0, 2}, {0, 0}, {255, 0, 0, 255}},
                                {{1, 0, 0}, {0, 0, 2}, {65535, 0}, {0, 255, 0, 255}},
                                {{0, 1, 0}, {0, 0, 2}, {0, 65535}, {0, 0, 51, 255}}};
  const int view = b.view(items, 32);
  const auto part = [&](int offset, int type, const char* shape, bool normalized) {
    return b.accessor({{"bufferView", view},
                       {"byteOffset", offset},
                       {"componentType", type},
                       {"type", shape},
                       {"count", 3},
                       {"normalized", normalized}});
  };
  const int position = part(0, float32, "VEC3", false), normal = part(12, float32, "VEC3", false),
            uv = part(24, uint16, "VEC2", true), colour = part(28, uint8, "VEC4", true);
  b.node({{"mesh", b.mesh({{"attributes",
                            {{"POSITION", position},
                             {"NORMAL", normal},
                             {"TEXCOORD_0", uv},
                             {"TEXCOORD_1", uv},
                             {"COLOR_0", colour}}}})}});
  const Model model = must_load(b);
  const Primitive& p = only_primitive(model);
  ASSERT_EQ(p.vertices.size(), 3u);
  EXPECT_EQ(p.vertices[1].position_m, glm::vec3(1, 0, 0));
  EXPECT_EQ(p.vertices[1].normal, glm::vec3(0, 0, 1)) << "normals come back with unit length";
  EXPECT_EQ(p.vertices[1].uv0, glm::vec2(1, 0));
  EXPECT_EQ(p.vertices[2].uv1, glm::vec2(0, 1));
  EXPECT_EQ(p.vertices[2].colour, glm::vec4(0, 0, 0.2f, 1));
}

TEST_F(Geometry, ThreePartColoursAreOpaque) {
  Builder b = Builder::triangle();
  b.primitive()["attributes"]["COLOR_0"] = b.data(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1}, float32, "VEC3", 3);
  EXPECT_EQ(only_primitive(must_load(b)).vertices[1].colour, glm::vec4(0, 1, 0, 1));
}

TEST_F(Geometry, QuantisedPositionsOfEveryType) {
  // KHR_mesh_quantization; normalised signed values follow section 3.11 of the specification: max(c/127, -1).
  const auto third_corner = [&](auto values, int type, bool normalized) {
    Builder b;
    b.root["extensionsUsed"] = b.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    json a = {{"bufferView", b.view(values, static_cast<int>(4 * sizeof(values[0])))},
              {"componentType", type},
              {"type", "VEC3"},
              {"count", 3}};
    if (normalized) a["normalized"] = true;
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", b.accessor(a)}}}})}});
    return corner(only_primitive(must_load(b)), 2);
  };
  EXPECT_EQ(third_corner(std::vector<std::int8_t>{0, 0, 0, 0, 1, 0, 0, 0, -128, 127, 64, 0}, int8, false),
            glm::vec3(-128, 127, 64));
  EXPECT_EQ(third_corner(std::vector<std::int8_t>{0, 0, 0, 0, 1, 0, 0, 0, -128, 127, 0, 0}, int8, true),
            glm::vec3(-1, 1, 0));
  EXPECT_EQ(third_corner(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 255, 51, 0, 0}, uint8, true),
            glm::vec3(1, 0.2f, 0));
  EXPECT_EQ(third_corner(std::vector<std::int16_t>{0, 0, 0, 0, 1, 0, 0, 0, -32768, 32767, 5, 0}, int16, false),
            glm::vec3(-32768, 32767, 5));
  EXPECT_EQ(third_corner(std::vector<std::int16_t>{0, 0, 0, 0, 1, 0, 0, 0, -32768, 32767, 0, 0}, int16, true),
            glm::vec3(-1, 1, 0));
  EXPECT_EQ(third_corner(std::vector<std::uint16_t>{0, 0, 0, 0, 1, 0, 0, 0, 65535, 13107, 0, 0}, uint16, true),
            glm::vec3(1, 0.2f, 0));
}

TEST_F(Geometry, SparseOverAViewAndOverNothing) {
  for (bool based : {true, false}) {
    Builder b;
    json a = {{"componentType", float32}, {"type", "VEC3"}, {"count", 3}};
    if (based) a["bufferView"] = b.view(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int indices = b.view(std::vector<std::uint16_t>{1, 2});
    const int values = b.view(std::vector<float>{5, 0, 0, 0, 7, 0});
    a["sparse"] = {{"count", 2},
                   {"indices", {{"bufferView", indices}, {"componentType", uint16}}},
                   {"values", {{"bufferView", values}}}};
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", b.accessor(a)}}}})}});
    const Model model = must_load(b);
    EXPECT_EQ(corner(only_primitive(model), 1), glm::vec3(5, 0, 0));
    EXPECT_EQ(corner(only_primitive(model), 2), glm::vec3(0, 7, 0));
  }
}

TEST_F(Geometry, SparseIndicesOfATriangle) {
  Builder b;
  const int position = b.positions(square);
  const int places = b.view(std::vector<std::uint8_t>{1, 2});
  const int values = b.view(std::vector<std::uint16_t>{1, 2});
  const int indices = b.accessor({{"componentType", uint16},
                                  {"type", "SCALAR"},
                                  {"count", 3},
                                  {"sparse",
                                   {{"count", 2},
                                    {"indices", {{"bufferView", places}, {"componentType", uint8}}},
                                    {"values", {{"bufferView", values}}}}}});
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}})}});
  const Model model = must_load(b);
  EXPECT_EQ(corner(only_primitive(model), 2), glm::vec3(1, 1, 0));
}

TEST_F(Geometry, HostileSparse) {
  const auto with = [&](const char* pointer, json value) {
    Builder b;
    const int values = b.view(std::vector<float>{5, 0, 0, 0, 7, 0});
    const int indices = b.view(std::vector<std::uint16_t>{1, 2});
    json a = {{"componentType", float32}, {"type", "VEC3"}, {"count", 3}};
    a["sparse"] = {{"count", 2},
                   {"indices", {{"bufferView", indices}, {"componentType", uint16}}},
                   {"values", {{"bufferView", values}}}};
    a[json::json_pointer(pointer)] = value;
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", b.accessor(a)}}}})}});
    return load(b);
  };
  ASSERT_TRUE(with("/sparse/count", 2));
  must_fail(with("/sparse/count", 3), {"/accessors/0/sparse"});
  must_fail(with("/sparse/count", 4), {"/accessors/0/sparse/count"});
  must_fail(with("/sparse/count", 4e9), {"/accessors/0/sparse/count"});
  must_fail(with("/sparse/count", -1), {"/accessors/0/sparse/count"});
  must_fail(with("/sparse/indices/byteOffset", 2), {"/accessors/0/sparse/indices"});
  must_fail(with("/sparse/indices/componentType", float32), {"/accessors/0/sparse/indices/componentType"});
  must_fail(with("/sparse/values/byteOffset", 4), {"/accessors/0/sparse/values"});
  must_fail(with("/sparse/values/bufferView", 9), {"/accessors/0/sparse/values/bufferView"});
  must_fail(with("/sparse/indices/bufferView", 0), {"/accessors/0/sparse/indices", "the accessor has 3 elements"});
  must_fail(with("/count", 2), {"/accessors/0/sparse/indices", "the accessor has 2 elements"});
  must_fail(with("/count", 4e9), {"/accessors/0/count"});
  must_fail(with("/sparse", json::array()), {"/accessors/0/sparse"});
}

TEST_F(Geometry, WithoutDataThereAreZeros) {
  Builder b;
  const int position = b.accessor({{"componentType", float32}, {"type", "VEC3"}, {"count", 3}});
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", position}}}})}});
  EXPECT_EQ(corner(only_primitive(must_load(b)), 2), glm::vec3(0));
}

TEST_F(Geometry, OneLargeBufferForManyPrimitives) {
  // Each primitive keeps only the vertices it uses.
  Builder b;
  std::vector<float> xyz(3000);
  for (std::size_t i = 0; i < xyz.size(); ++i) xyz[i] = static_cast<float>(i);
  const int position = b.positions(xyz);
  const int normal = b.data(std::vector<float>(3000, 1.0f), float32, "VEC3", 3);
  const int few = b.data(std::vector<std::uint16_t>{999, 3, 500}, uint16, "SCALAR", 1);
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"indices", few}})}});
  const Model model = must_load(b);
  EXPECT_EQ(only_primitive(model).vertices.size(), 3u);
  EXPECT_EQ(corner(only_primitive(model), 0).x, 2997.0f);
  EXPECT_EQ(corner(only_primitive(model), 1).x, 9.0f);
  EXPECT_EQ(corner(only_primitive(model), 2).x, 1500.0f);
}

TEST_F(Geometry, TangentsFollowTheTexture) {
  Builder b;
  const int position = b.positions(square);
  const int normal = b.data(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, float32, "VEC3", 3);
  // u grows along +y and v, which points down in an image, along -x... a map turned by 90 degrees.
  const int uv = b.data(std::vector<float>{0, 0, 0, 1, 1, 1, 1, 0}, float32, "VEC2", 2);
  const int indices = b.data(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, uint8, "SCALAR", 1);
  b.root["images"] = {{{"uri", "data:image/png;base64," + base64(png(1, 1, 8, 2, {0, 128, 128, 255}))}}};
  b.root["textures"] = {{{"source", 0}}};
  b.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}},
                           {"indices", indices},
                           {"material", 0}})}});
  const Model model = must_load(b);
  for (const Vertex& v : only_primitive(model).vertices) {
    EXPECT_NEAR(glm::length(glm::vec3(v.tangent) - glm::vec3(0, 1, 0)), 0.0f, 1e-6f) << "along growing u";
    // The bitangent, cross(normal, tangent) x w, points to the top of the image: against growing v (+x here).
    const glm::vec3 bitangent = glm::cross(v.normal, glm::vec3(v.tangent)) * v.tangent.w;
    EXPECT_NEAR(glm::length(bitangent - glm::vec3(-1, 0, 0)), 0.0f, 1e-6f);
  }
}

TEST_F(Geometry, MirroredHalvesDoNotShareTangents) {
  Builder b;
  const int position = b.positions({0, 0, 0, 1, 0, 0, 1, 1, 0, -1, 1, 0});
  const int normal = b.data(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, float32, "VEC3", 3);
  const int uv = b.data(std::vector<float>{0, 1, 1, 1, 1, 0, 1, 0}, float32, "VEC2", 2);
  const int indices = b.data(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, uint8, "SCALAR", 1);
  b.root["images"] = {{{"uri", "data:image/png;base64," + base64(png(1, 1, 8, 2, {0, 128, 128, 255}))}}};
  b.root["textures"] = {{{"source", 0}}};
  b.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}},
                           {"indices", indices},
                           {"material", 0}})}});
  const Model model = must_load(b);
  for (const Vertex& v : only_primitive(model).vertices) {
    EXPECT_NEAR(glm::length(glm::vec3(v.tangent)), 1.0f, 1e-5f);
    EXPECT_TRUE(v.tangent.w == 1.0f || v.tangent.w == -1.0f);
    EXPECT_NEAR(glm::dot(glm::vec3(v.tangent), v.normal), 0.0f, 1e-6f);
  }
}

TEST_F(Geometry, GivenTangentsAreKept) {
  Builder b = Builder::triangle();
  b.primitive()["attributes"]["NORMAL"] = b.data(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, float32, "VEC3", 3);
  b.primitive()["attributes"]["TANGENT"] =
      b.data(std::vector<float>{0, 2, 0, -1, 0, 2, 0, -1, 0, 2, 0, -1}, float32, "VEC4", 4);
  EXPECT_EQ(only_primitive(must_load(b)).vertices[0].tangent, glm::vec4(0, 1, 0, -1));
}

TEST_F(Geometry, MorphTargetsStandAtTheirWeights) {
  Builder b = Builder::triangle();
  const int delta = b.data(std::vector<float>{0, 0, 4, 0, 0, 4, 0, 0, 4}, float32, "VEC3", 3);
  b.primitive()["targets"] = {{{"POSITION", delta}}};
  b.root["meshes"][0]["weights"] = {0.5};
  b.node({{"mesh", 0}, {"weights", {1.0}}});
  b.node({{"mesh", 0}});
  const Model model = must_load(b);
  const auto height = [&](std::size_t node) {
    return corner(model.meshes.at(static_cast<std::size_t>(model.nodes.at(node).mesh)).primitives.at(0), 0).z;
  };
  EXPECT_EQ(height(0), 2.0f);
  EXPECT_EQ(height(1), 4.0f);
  EXPECT_EQ(model.nodes[0].mesh, model.nodes[2].mesh) << "the same mesh at the same weights stays shared";
}

TEST_F(Geometry, LeftoverIndicesWarn) {
  Builder b = Builder::triangle();
  b.primitive()["indices"] = b.data(std::vector<std::uint8_t>{0, 1, 2, 0}, uint8, "SCALAR", 1);
  const Model model = must_load(b);
  EXPECT_EQ(only_primitive(model).indices.size(), 3u);
  EXPECT_TRUE(warned(model, "/meshes/0/primitives/0"));
}

TEST_F(Geometry, NormalsOfNoLengthAreReplaced) {
  Builder b = Builder::triangle();
  b.primitive()["attributes"]["NORMAL"] = b.data(std::vector<float>(9, 0.0f), float32, "VEC3", 3);
  const Model model = must_load(b);
  for (const Vertex& v : only_primitive(model).vertices) EXPECT_EQ(v.normal, glm::vec3(0, 0, 1));
}

TEST_F(Geometry, IndicesOutOfRange) {
  for (std::uint32_t bad : {3u, 255u, 65535u, 4294967295u}) {
    Builder b = Builder::triangle();
    b.primitive()["indices"] = b.data(std::vector<std::uint32_t>{0, 1, bad}, uint32, "SCALAR", 1);
    must_fail(b, {"/meshes/0/primitives/0/indices", "entry 2", std::to_string(bad).c_str(), "3 vertices"});
  }
}

TEST_F(Geometry, AccessorsOutOfRange) {
  const auto with = [&](const char* pointer, json value) {
    Builder b = Builder::triangle();
    b.root[json::json_pointer(pointer)] = std::move(value);
    return load(b);
  };
  must_fail(with("/accessors/0/count", 4), {"/accessors/0", "4 elements", "36 bytes"});
  must_fail(with("/accessors/0/count", 4000000000u), {"/accessors/0", "4000000000"});
  must_fail(with("/accessors/0/count", 9007199254740992ull), {"/accessors/0"});
  must_fail(with("/accessors/0/count", 18446744073709551615ull), {"/accessors/0/count"});
  must_fail(with("/accessors/0/count", 1537228672809129301ull), {"/accessors/0/count"});  // x 12 wraps to 36 - 24
  must_fail(with("/accessors/0/count", 0), {"/accessors/0/count"});
  must_fail(with("/accessors/0/count", -3), {"/accessors/0/count", "-3"});
  must_fail(with("/accessors/0/count", 2.5), {"/accessors/0/count", "2.5"});
  must_fail(with("/accessors/0/count", "3"), {"/accessors/0/count", "\"3\""});
  must_fail(with("/accessors/0/byteOffset", 4), {"/accessors/0"});
  must_fail(with("/accessors/0/byteOffset", 9007199254740992ull), {"/accessors/0"});
  must_fail(with("/accessors/0/byteOffset", 18446744073709551612ull), {"/accessors/0/byteOffset"});
  must_fail(with("/accessors/0/byteOffset", -4), {"/accessors/0/byteOffset"});
  must_fail(with("/accessors/0/bufferView", 1), {"/accessors/0/bufferView", "1"});
  must_fail(with("/accessors/0/bufferView", -1), {"/accessors/0/bufferView"});
  must_fail(with("/accessors/0/bufferView", nullptr), {"/accessors/0/bufferView", "null"});
  must_fail(with("/accessors/0/componentType", 5130), {"/accessors/0/componentType"});
  must_fail(with("/accessors/0/componentType", 5124), {"/accessors/0/componentType"});
  must_fail(with("/accessors/0/type", "VEC5"), {"VEC5"});
  must_fail(with("/accessors/0/type", "VEC2"), {"POSITION", "/accessors/0"});
  must_fail(with("/bufferViews/0/byteLength", 37), {"/bufferViews/0/byteLength", "36"});
  must_fail(with("/bufferViews/0/byteLength", 9007199254740992ull), {"/bufferViews/0/byteLength"});
  must_fail(with("/bufferViews/0/byteLength", 0), {"/bufferViews/0/byteLength"});
  must_fail(with("/bufferViews/0/byteOffset", 1), {"/bufferViews/0/byteLength"});
  must_fail(with("/bufferViews/0/byteOffset", 9007199254740991ull), {"/bufferViews/0/byteOffset"});
  must_fail(with("/bufferViews/0/byteStride", 8), {"/bufferViews/0/byteStride", "12 bytes"});
  must_fail(with("/bufferViews/0/byteStride", 16), {"/accessors/0"});
  must_fail(with("/bufferViews/0/byteStride", 13), {"/bufferViews/0/byteStride"});
  must_fail(with("/bufferViews/0/byteStride", 256), {"/bufferViews/0/byteStride"});
  must_fail(with("/bufferViews/0/buffer", 1), {"/bufferViews/0/buffer"});
  must_fail(with("/meshes/0/primitives/0/attributes/POSITION", 7), {"/meshes/0/primitives/0/attributes/POSITION"});
  must_fail(with("/meshes/0/primitives/0/attributes", json::array()), {"/meshes/0/primitives/0/attributes"});
  must_fail(with("/meshes/0/primitives/0/indices", 1), {"/meshes/0/primitives/0/indices"});
  must_fail(with("/meshes/0/primitives/0/indices", 0), {"/meshes/0/primitives/0/indices", "SCALAR"});
  must_fail(with("/meshes/0/primitives/0/material", 0), {"/meshes/0/primitives/0/material"});
  must_fail(with("/meshes/0/primitives", "x"), {"/meshes/0/primitives"});
  must_fail(with("/meshes", json::object()), {"/nodes/0/mesh", "0 meshes"});
}

TEST_F(Geometry, AttributesOfUnequalCount) {
  Builder b = Builder::triangle();
  b.primitive()["attributes"]["NORMAL"] = b.data(std::vector<float>{0, 0, 1, 0, 0, 1}, float32, "VEC3", 3);
  must_fail(b, {"/meshes/0/primitives/0/attributes/NORMAL", "2", "3"});
}

TEST_F(Geometry, NoFiniteNumbers) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  for (float bad : {inf, -inf, nan, 3e38f}) {
    Builder b;
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", b.positions({0, 0, 0, 1, bad, 0, 0, 1, 0})}}}})}});
    must_fail(b, {"/accessors/0", "element 1"});
  }
  Builder b = Builder::triangle();
  b.primitive()["attributes"]["NORMAL"] = b.data(std::vector<float>{0, 0, 1, 0, 0, nan, 0, 0, 1}, float32, "VEC3", 3);
  must_fail(b, {"/accessors/1", "element 1", "nan"});
}

TEST_F(Geometry, SmallFileThatAsksForMuch) {
  // A million zeros, named by a thousand primitives.
  Builder b;
  const int position = b.accessor({{"componentType", float32}, {"type", "VEC3"}, {"count", 1'000'000}});
  b.root["meshes"] = {{{"primitives", json::array()}}};
  for (int i = 0; i < 1000; ++i)
    b.root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", position}}}});
  b.node({{"mesh", 0}});
  must_fail(b, {"/accessors/0/count", "without a bufferView"});
}

}  // namespace
}  // namespace petrichor::testing_gltf
