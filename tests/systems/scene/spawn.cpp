#include "systems/scene/spawn.hpp"

#include <gtest/gtest.h>

namespace petrichor {
namespace {

Model small_model() {
  Model model;
  model.source = "street.glb";
  model.meshes.resize(2);
  model.lights.push_back(ModelLight{"lamp", ModelLightKind::spot, {1.0f, 0.5f, 0.25f}, 300.0f, 12.0f, 0.25f, 0.5f});
  model.cameras.push_back(ModelCamera{"eye", 1.0f, 0.2f});
  Node root;
  root.name = "root";
  root.translation_m = {1, 2, 3};
  root.scale = {2, 2, 2};
  root.json_path = "/nodes/4";
  Node child;
  child.parent = 0;
  child.mesh = 1;
  child.light = 0;
  child.camera = 0;
  child.json_path = "/nodes/7";
  model.nodes = {root, child};
  return model;
}

TEST(Spawn, NodesBecomeEntities) {
  Registry registry;
  const auto entities = spawn_model(registry, small_model(), 5);
  ASSERT_TRUE(entities) << entities.error().message;
  ASSERT_EQ(entities->size(), 2u);
  const Entity root = (*entities)[0], child = (*entities)[1];
  EXPECT_EQ(registry.get<Name>(root).text, "root");
  EXPECT_EQ(registry.get<Transform>(root).position_m, glm::vec3(1, 2, 3));
  EXPECT_EQ(registry.get<Transform>(root).scale, glm::vec3(2));
  EXPECT_FALSE(registry.has<Parent>(root));
  EXPECT_FALSE(registry.has<MeshInstance>(root));
  EXPECT_EQ(registry.get<Parent>(child).entity, root);
  EXPECT_EQ(registry.get<MeshInstance>(child).model, 5u);
  EXPECT_EQ(registry.get<MeshInstance>(child).mesh, 1u);
  const Light& light = registry.get<Light>(child);
  EXPECT_EQ(light.kind, LightKind::spot);
  EXPECT_EQ(light.intensity_cd, 300.0f);
  EXPECT_EQ(light.range_m, 12.0f);
  EXPECT_EQ(light.colour, glm::vec3(1.0f, 0.5f, 0.25f));
  EXPECT_NEAR(light.inner_cone_deg, 14.3239, 1e-3);  // 0.25 rad
  EXPECT_NEAR(light.outer_cone_deg, 28.6479, 1e-3);
  EXPECT_FALSE(light.casts_shadow);
  const Camera& camera = registry.get<Camera>(child);
  EXPECT_NEAR(camera.vertical_fov_deg, 57.2958, 1e-3);
  EXPECT_EQ(camera.near_m, 0.2f);
  EXPECT_FALSE(camera.active);
}

TEST(Spawn, RootsHangUnderTheGivenParent) {
  Registry registry;
  const Entity above = registry.create();
  const auto entities = spawn_model(registry, small_model(), 0, above);
  ASSERT_TRUE(entities);
  EXPECT_EQ(registry.get<Parent>((*entities)[0]).entity, above);
  EXPECT_EQ(registry.get<Parent>((*entities)[1]).entity, (*entities)[0]);
}

TEST(Spawn, ComponentsRideInExtras) {
  Model model = small_model();
  model.nodes[0].extras_json =
      R"({"drip_source": {"length_m": 3.5}, "puddle": {}, "artist": "me", "wind": 7, "unknown_thing": {"x": 1}})";
  model.nodes[1].extras_json =
      R"({"light": {"casts_shadow": true}, "petrichor": {"camera": {"active": true}, "glass_pane": {"size_m": [4, 2]}}})";
  Registry registry;
  const auto entities = spawn_model(registry, model, 0);
  ASSERT_TRUE(entities) << entities.error().message;
  const Entity root = (*entities)[0], child = (*entities)[1];
  EXPECT_EQ(registry.get<DripSource>(root).length_m, 3.5f);
  EXPECT_TRUE(registry.has<Puddle>(root));
  EXPECT_FALSE(registry.has<Wind>(root)) << "a number is somebody else's";
  EXPECT_TRUE(registry.get<Light>(child).casts_shadow);
  EXPECT_EQ(registry.get<Light>(child).intensity_cd, 300.0f) << "the rest of the light stays";
  EXPECT_TRUE(registry.get<Camera>(child).active);
  EXPECT_EQ(registry.get<GlassPane>(child).size_m, glm::vec2(4, 2));
}

TEST(Spawn, WrongExtrasNameFileAndPathAndSpawnNothing) {
  const auto message = [](const char* extras) {
    Model model = small_model();
    model.nodes[1].extras_json = extras;
    Registry registry;
    const auto entities = spawn_model(registry, model, 0);
    EXPECT_FALSE(entities) << extras;
    EXPECT_EQ(registry.size(), 0u);
    return entities ? std::string() : entities.error().message;
  };
  for (const char* extras : {R"({"drip_source": {"length_m": "long"}})", R"({"drip_source": {"lenght_m": 2}})",
                             R"({"drip_source": {"length_m": -1e30}})"}) {
    const std::string text = message(extras);
    EXPECT_NE(text.find("street.glb: /nodes/7/extras/drip_source"), std::string::npos) << text;
    EXPECT_NE(text.find("length_m"), std::string::npos) << text;
  }
  EXPECT_NE(message(R"({"petrichor": {"puddel": {}}})").find("/nodes/7/extras/petrichor/puddel"), std::string::npos);
  EXPECT_NE(message(R"({"petrichor": {"puddle": 3}})").find("/nodes/7/extras/petrichor/puddle"), std::string::npos);
}

TEST(Spawn, EmptyModel) {
  Registry registry;
  const auto entities = spawn_model(registry, Model{}, 0);
  ASSERT_TRUE(entities);
  EXPECT_TRUE(entities->empty());
}

}  // namespace
}  // namespace petrichor
