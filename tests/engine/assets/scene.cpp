// Nodes, scenes, lights and cameras.
#include <glm/gtc/matrix_transform.hpp>

#include "tests/engine/assets/gltf_builder.hpp"

namespace petrichor::testing_gltf {
namespace {

class Scene : public Assets {};

glm::mat4 local_matrix(const Node& n) {
  return glm::translate(glm::mat4(1), n.translation_m) * glm::mat4_cast(n.rotation) * glm::scale(glm::mat4(1), n.scale);
}

void expect_near(const glm::mat4& a, const glm::mat4& b, float tolerance) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(a[c][r], b[c][r], tolerance) << "column " << c << ", row " << r;
  }
}

json matrix_json(const glm::mat4& m) {
  json out = json::array();
  for (int i = 0; i < 16; ++i) out.push_back(m[i / 4][i % 4]);
  return out;
}

TEST_F(Scene, ParentsComeBeforeChildrenAndSharedMeshesStayShared) {
  Builder b = Builder::triangle();
  b.root["nodes"] = json::parse(
      R"([{"name": "leaf", "mesh": 0}, {"name": "root", "children": [2, 0]}, {"name": "middle", "children": [3]}, {"mesh": 0}])");
  const Model model = must_load(b);
  ASSERT_EQ(model.nodes.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(model.nodes[i].parent, static_cast<std::int32_t>(i));
  EXPECT_EQ(model.nodes[0].name, "root");
  EXPECT_EQ(model.nodes[1].name, "middle");
  EXPECT_EQ(model.nodes[3].name, "leaf");
  EXPECT_EQ(model.nodes[3].json_path, "/nodes/0");
  EXPECT_EQ(model.nodes[3].parent, 0);
  EXPECT_EQ(model.nodes[2].parent, 1);
  EXPECT_EQ(model.nodes[2].mesh, model.nodes[3].mesh);
  EXPECT_EQ(model.meshes.size(), 1u);
}

TEST_F(Scene, TheDefaultSceneIsLoaded) {
  Builder b = Builder::triangle();
  b.root["nodes"] = json::parse(R"([{"name": "a"}, {"name": "b"}, {"name": "c"}])");
  EXPECT_EQ(must_load(b).nodes.size(), 3u) << "no scenes: every root";
  b.root["scenes"] = json::parse(R"([{"nodes": [0, 2]}, {"nodes": [1]}])");
  EXPECT_EQ(must_load(b).nodes.size(), 2u) << "no default: the first";
  b.root["scene"] = 1;
  const Model model = must_load(b);
  ASSERT_EQ(model.nodes.size(), 1u);
  EXPECT_EQ(model.nodes[0].name, "b");
  b.root["scene"] = 2;
  must_fail(b, {"/scene", "2"});
  b.root["scene"] = 0;
  b.root["scenes"][0] = json::object();
  EXPECT_TRUE(warned(must_load(b), "no nodes"));
}

TEST_F(Scene, MatricesDecompose) {
  // Rotations with positive, mirrored, flat and tiny scales: translation x rotation x scale gives the matrix back.
  const glm::mat4 turned = glm::rotate(glm::mat4(1), 2.1f, glm::normalize(glm::vec3(1, -2, 0.5f)));
  for (const glm::vec3 scale :
       {glm::vec3(1, 2, 3), glm::vec3(-1, 1, 1), glm::vec3(1, -4, 2), glm::vec3(-2, -2, -2), glm::vec3(5, 0, 1),
        glm::vec3(0, 0, 2), glm::vec3(0, 0, 0), glm::vec3(1e-5f, 1e3f, 1e3f)}) {
    const glm::mat4 m = glm::translate(glm::mat4(1), glm::vec3(7, 8, 9)) * turned * glm::scale(glm::mat4(1), scale);
    Builder b;
    b.node({{"matrix", matrix_json(m)}});
    const Model model = must_load(b);
    expect_near(local_matrix(model.nodes.at(0)), m, 1e-5f * std::max(1.0f, glm::length(scale)));
    EXPECT_NEAR(glm::length(model.nodes[0].rotation), 1.0f, 1e-5f);
    EXPECT_FALSE(warned(model, "shear"));
  }
}

TEST_F(Scene, ShearIsDroppedWithAWarning) {
  glm::mat4 m(1);
  m[1][0] = 0.5f;
  Builder b;
  b.node({{"matrix", matrix_json(m)}});
  EXPECT_TRUE(warned(must_load(b), "/nodes/0/matrix"));
}

TEST_F(Scene, TransformsAndBounds) {
  Builder b = Builder::triangle();
  const float h = std::sqrt(0.5f);
  b.root["nodes"] = {{{"translation", {10, 0, 0}}, {"children", {1}}},
                     {{"mesh", 0}, {"rotation", {0, 0, h, h}}, {"scale", {2, 2, 2}}}};
  const Model model = must_load(b);
  glm::vec3 low, high;
  ASSERT_TRUE(model_bounds(model, low, high));
  // A quarter turn about z takes +x to +y and +y to -x.
  EXPECT_NEAR(low.x, 8.0f, 1e-5f);
  EXPECT_NEAR(high.x, 10.0f, 1e-5f);
  EXPECT_NEAR(low.y, 0.0f, 1e-5f);
  EXPECT_NEAR(high.y, 2.0f, 1e-5f);
}

TEST_F(Scene, BadTransforms) {
  const auto with = [&](json node) {
    Builder b;
    b.node(std::move(node));
    return load(b);
  };
  must_fail(with({{"rotation", {0, 0, 0, 0}}}), {"/nodes/0/rotation"});
  must_fail(with({{"rotation", {0, 0, 1}}}), {"/nodes/0/rotation", "3 numbers"});
  must_fail(with({{"matrix", {1, 2, 3}}}), {"/nodes/0/matrix"});
  must_fail(with({{"translation", {0, "NaN", 0}}}), {"/nodes/0/translation/1"});
  must_fail(with({{"scale", {1e39, 1, 1}}}), {"/nodes/0/scale/0"});
  must_fail(with({{"scale", nullptr}}), {"/nodes/0/scale"});
  must_fail(with({{"matrix", json(std::vector<double>(16, 3e38))}}), {"/nodes/0"});
  must_fail(with({{"mesh", 0}}), {"/nodes/0/mesh", "there are 0 meshes"});
  must_fail(with({{"camera", 3}}), {"/nodes/0/camera"});
  must_fail(with({{"skin", 3}}), {"/nodes/0/skin"});
  must_fail(with({{"children", {9}}}), {"/nodes/0/children/0"});
  must_fail(with({{"children", 1}}), {"/nodes/0/children"});
  must_fail(with({{"name", {1}}}), {"/nodes/0/name"});
  must_fail(with(5), {"/nodes/0"});
}

TEST_F(Scene, OverflowDownTheTree) {
  Builder b;
  for (int i = 0; i < 10; ++i) b.node({{"scale", {1e6, 1e6, 1e6}}, {"children", {i + 1}}});
  b.node(json::object());
  must_fail(b, {"/nodes/", "at most"});
}

TEST_F(Scene, NoCyclesNoSecondParents) {
  Builder b;
  b.root["nodes"] = json::parse(R"([{"children": [1]}, {"children": [2]}, {"children": [0]}])");
  must_fail(b, {"/nodes/0", "descendants"});
  b.root["nodes"] = json::parse(R"([{"children": [0]}])");
  must_fail(b, {"/nodes/0/children/0", "own child"});
  b.root["nodes"] = json::parse(R"([{"children": [2]}, {"children": [2]}, {}])");
  must_fail(b, {"/nodes/1/children/0", "node 2"});
  b.root["nodes"] = json::parse(R"([{"children": [1, 1]}, {}])");
  must_fail(b, {"/nodes/0/children/1"});
  b.root["nodes"] = json::parse(R"([{"children": [1]}, {}])");
  b.root["scenes"] = json::parse(R"([{"nodes": [0, 1]}])");
  must_fail(b, {"/scenes/0/nodes/1"});
  b.root["scenes"] = json::parse(R"([{"nodes": [0, 0]}])");
  must_fail(b, {"/scenes/0/nodes/1", "twice"});
  b.root["scenes"] = json::parse(R"([{"nodes": [7]}])");
  must_fail(b, {"/scenes/0/nodes/0", "7"});
}

TEST_F(Scene, HundredThousandDeep) {
  constexpr int depth = 100000;
  json nodes = json::array();
  for (int i = 0; i < depth; ++i) {
    json node = {{"translation", {0, 0.001, 0}}};
    if (i + 1 < depth) node["children"] = {i + 1};
    nodes.push_back(std::move(node));
  }
  Builder b = Builder::triangle();
  nodes.back()["mesh"] = 0;
  b.root["nodes"] = std::move(nodes);
  const Model model = must_load(b);
  ASSERT_EQ(model.nodes.size(), static_cast<std::size_t>(depth));
  EXPECT_EQ(model.nodes.back().parent, depth - 2);
  glm::vec3 low, high;
  ASSERT_TRUE(model_bounds(model, low, high));
  EXPECT_NEAR(low.y, 100.0f, 0.5f);
}

TEST_F(Scene, HundredThousandDeepCycle) {
  json nodes = json::array();
  for (int i = 0; i < 100000; ++i) nodes.push_back({{"children", {(i + 1) % 100000}}});
  Builder b;
  b.root["nodes"] = std::move(nodes);
  must_fail(b, {"/nodes/0"});
}

TEST_F(Scene, Lights) {
  Builder b;
  b.root["extensionsUsed"] = {"KHR_lights_punctual"};
  b.root["extensions"]["KHR_lights_punctual"]["lights"] = json::parse(R"([
    {"type": "spot", "name": "lamp", "color": [1, 0.5, 0.25], "intensity": 300, "range": 12, "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
    {"type": "directional", "intensity": 2}, {"type": "point"}, {"type": "spot", "spot": {}}])");
  b.node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  b.node(json::object());
  const Model model = must_load(b);
  ASSERT_EQ(model.lights.size(), 4u);
  EXPECT_EQ(model.nodes[0].light, 0);
  EXPECT_EQ(model.nodes[1].light, no_index);
  EXPECT_EQ(model.lights[0].kind, ModelLightKind::spot);
  EXPECT_EQ(model.lights[0].colour, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(model.lights[0].intensity, 300.0f);
  EXPECT_EQ(model.lights[0].range_m, 12.0f);
  EXPECT_EQ(model.lights[0].inner_cone_rad, 0.25f);
  EXPECT_EQ(model.lights[0].outer_cone_rad, 0.5f);
  EXPECT_EQ(model.lights[1].kind, ModelLightKind::directional);
  EXPECT_EQ(model.lights[2].kind, ModelLightKind::point);
  EXPECT_EQ(model.lights[2].intensity, 1.0f);
  EXPECT_FLOAT_EQ(model.lights[3].outer_cone_rad, 0.7853981634f);
  b.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 4;
  must_fail(b, {"/nodes/0/extensions/KHR_lights_punctual/light", "there are 4 lights"});
  b.root["nodes"][0] = json::object();
  b.root["extensions"]["KHR_lights_punctual"]["lights"][2]["type"] = "area";
  must_fail(b, {"/extensions/KHR_lights_punctual/lights/2/type", "area"});
  b.root["extensions"]["KHR_lights_punctual"]["lights"] = 5;
  must_fail(b, {"/extensions/KHR_lights_punctual/lights"});
}

TEST_F(Scene, Cameras) {
  Builder b;
  b.root["cameras"] = json::parse(R"([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.2}},
    {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}}])");
  b.node({{"camera", 0}});
  const Model model = must_load(b);
  EXPECT_EQ(model.nodes.at(0).camera, 0);
  EXPECT_EQ(model.cameras.at(0).vertical_fov_rad, 0.5f);
  EXPECT_EQ(model.cameras.at(0).near_m, 0.2f);
  EXPECT_TRUE(warned(model, "/cameras/1"));
  b.root["cameras"][0].erase("perspective");
  must_fail(b, {"/cameras/0", "perspective"});
  b.root["cameras"][0]["type"] = "fisheye";
  must_fail(b, {"/cameras/0/type", "fisheye"});
}

TEST_F(Scene, ExtrasRideAlong) {
  Builder b;
  b.node({{"extras", {{"puddle", {{"size_m", {1, 2}}}}}}});
  b.node({{"extras", 5}});
  const Model model = must_load(b);
  EXPECT_EQ(json::parse(model.nodes.at(0).extras_json)["puddle"]["size_m"][1], 2);
  EXPECT_EQ(model.nodes.at(1).extras_json, "");
}

TEST_F(Scene, SkinnedMeshesStandWhereTheirJointsDo) {
  Builder b = Builder::triangle();
  b.primitive()["attributes"]["JOINTS_0"] =
      b.data(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, uint8, "VEC4", 4);
  b.primitive()["attributes"]["WEIGHTS_0"] =
      b.data(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, float32, "VEC4", 4);
  // Bound at the origin and at (1, 0, 0); they stand at (10, 0, 0) and (10, 0, 4). The node's own place is ignored.
  const int bind = b.data(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                             1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1},
                          float32, "MAT4", 16);
  b.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", bind}}};
  b.root["nodes"] =
      json::parse(R"([{"mesh": 0, "skin": 0, "translation": [500, 0, 0]}, {"translation": [10, 0, 0], "children": [2]},
                                    {"translation": [0, 0, 4]}])");
  const Model model = must_load(b);
  const Primitive& p = model.meshes.at(0).primitives.at(0);
  EXPECT_EQ(p.vertices.at(p.indices.at(0)).position_m, glm::vec3(10, 0, 0));
  EXPECT_EQ(p.vertices.at(p.indices.at(1)).position_m, glm::vec3(10, 0, 4));
  EXPECT_EQ(p.vertices.at(p.indices.at(2)).position_m, glm::vec3(9.5f, 1, 2))
      << "halfway between (10, 1, 0) and (9, 1, 4)";
  glm::vec3 low, high;
  ASSERT_TRUE(model_bounds(model, low, high));
  EXPECT_EQ(high, glm::vec3(10, 1, 4));
  EXPECT_TRUE(warned(model, "/skins/0"));
  b.root["skins"][0]["joints"] = {1};
  must_fail(b, {"/accessors/1", "joint 1", "/skins/0 has 1"});
  b.root["skins"][0]["joints"] = {1, 2, 0};
  must_fail(b, {"/skins/0/inverseBindMatrices"});
  b.root["skins"][0]["joints"] = {1, 3};
  must_fail(b, {"/skins/0/joints/1"});
}

TEST_F(Scene, AnimationsAreNamedInAWarning) {
  Builder b = Builder::triangle();
  b.root["animations"] = json::parse(R"([{"name": "wave", "channels": [], "samplers": []}])");
  EXPECT_TRUE(warned(must_load(b), "wave"));
}

TEST_F(Scene, WarningsAreFew) {
  Builder b = Builder::triangle();
  for (int i = 0; i < 5000; ++i) b.root["animations"].push_back({{"name", "wave"}});
  EXPECT_LE(must_load(b).warnings.size(), 110u);
}

}  // namespace
}  // namespace petrichor::testing_gltf
