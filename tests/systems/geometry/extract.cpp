#include "systems/geometry/extract.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "components/light.hpp"
#include "components/transform.hpp"
#include "components/view.hpp"

namespace petrichor::test {
namespace {

constexpr double step_s = 1.0 / 120.0;

struct MovingCamera {
  Registry registry;
  Entity entity = registry.create();
  MovingCamera() { registry.emplace<Camera>(entity); }
  void tick(glm::vec3 position, glm::quat orientation = {1, 0, 0, 0}) {
    const glm::mat4 m = glm::translate(glm::mat4(1.0f), position) * glm::mat4_cast(orientation);
    registry.emplace_or_replace<WorldTransform>(entity, m);
    track_cameras(registry);
  }
  FrameCamera extract(double interpolation = 1.0) {
    Frame frame;
    extract_camera(registry, frame, interpolation, step_s);
    return frame.camera;
  }
};

TEST(ExtractCamera, RestsOnTheFirstTick) {
  MovingCamera c;
  c.tick({100, 2, -30});
  EXPECT_EQ(c.extract().velocity_mps, glm::vec3(0));
  EXPECT_EQ(c.extract().angular_velocity_radps, glm::vec3(0));
  EXPECT_EQ(c.extract(0.25).position_m, glm::dvec3(100, 2, -30));
}

TEST(ExtractCamera, VelocityAndPlaceBetweenTicks) {
  MovingCamera c;
  c.tick({0, 2, 0});
  c.tick({0.05f, 2, -0.025f});
  const FrameCamera half = c.extract(0.5);
  EXPECT_NEAR(half.velocity_mps.x, 6.0f, 1e-4f);
  EXPECT_NEAR(half.velocity_mps.z, -3.0f, 1e-4f);
  EXPECT_NEAR(half.position_m.x, 0.025, 1e-6);
  EXPECT_NEAR(half.position_m.z, -0.0125, 1e-6);
}

TEST(ExtractCamera, AngularVelocityIsAboutWorldAxesTheShortWay) {
  MovingCamera c;
  // Turning left about the world's y while looking down a little: the world axis stays y.
  const glm::quat pitch = glm::angleAxis(-0.4f, glm::vec3(1, 0, 0));
  c.tick({0, 0, 0}, pitch);
  c.tick({0, 0, 0}, -(glm::angleAxis(0.02f, glm::vec3(0, 1, 0)) * pitch));
  const FrameCamera half = c.extract(0.5);
  EXPECT_NEAR(half.angular_velocity_radps.y, 0.02 / step_s, 0.01);
  EXPECT_NEAR(half.angular_velocity_radps.x, 0.0, 0.01);
  EXPECT_NEAR(half.angular_velocity_radps.z, 0.0, 0.01);
  const glm::quat expected = glm::angleAxis(0.01f, glm::vec3(0, 1, 0)) * pitch;
  EXPECT_GT(std::abs(glm::dot(half.orientation, expected)), 1.0f - 1e-5f);
}

TEST(ExtractCamera, AJumpIsNoMotion) {
  MovingCamera c;
  c.tick({0, 0, 0});
  c.tick({0.1f, 0, 0});
  c.tick({60.1f, 0, 0});
  EXPECT_EQ(c.extract().velocity_mps, glm::vec3(0));
  EXPECT_EQ(c.extract(0.0).position_m, glm::dvec3(glm::vec3(60.1f, 0, 0))) << "not seen halfway";
  c.tick({60.2f, 0, 0});
  EXPECT_NEAR(c.extract().velocity_mps.x, 12.0f, 1e-2f);
}

TEST(ExtractCamera, TakesTheActiveOne) {
  MovingCamera c;
  c.registry.get<Camera>(c.entity).active = false;
  c.tick({1, 0, 0});
  const Entity other = c.registry.create();
  c.registry.emplace<Camera>(other);
  c.registry.emplace<WorldTransform>(other, glm::translate(glm::mat4(1.0f), {2, 0, 0}));
  EXPECT_EQ(c.extract().position_m.x, 2.0);
  c.registry.get<Camera>(other).active = false;
  Frame frame;
  frame.camera.position_m = {9, 9, 9};
  extract_camera(c.registry, frame, 1.0, step_s);
  EXPECT_EQ(frame.camera.position_m.x, 9.0) << "left alone";
}

TEST(ExtractInstances, TheVersionFollowsTheContent) {
  Registry registry;
  std::vector<Entity> things;
  for (int i = 0; i < 3; ++i) {
    things.push_back(registry.create());
    registry.emplace<MeshInstance>(things.back(), 0u, static_cast<std::uint32_t>(i));
    registry.emplace<WorldTransform>(things.back());
  }
  const auto version = [&] {
    Frame frame;
    extract_instances(registry, frame);
    EXPECT_EQ(frame.instances.size(), registry.size<MeshInstance>());
    return frame.geometry_version;
  };
  const std::uint64_t first = version();
  EXPECT_EQ(version(), first);
  registry.get<WorldTransform>(things[1]).matrix[3].x = 0.001f;
  const std::uint64_t moved = version();
  EXPECT_NE(moved, first);
  registry.get<WorldTransform>(things[1]).matrix[3].x = 0.0f;
  EXPECT_EQ(version(), first);
  registry.get<MeshInstance>(things[2]).casts_shadow = false;
  EXPECT_NE(version(), first);
  registry.get<MeshInstance>(things[2]).casts_shadow = true;
  registry.remove<MeshInstance>(things[0]);
  EXPECT_NE(version(), first);
}

TEST(ExtractLights, PlaceDirectionAndVersions) {
  Registry registry;
  const Entity lamp = registry.create();
  Light light;
  light.kind = LightKind::spot;
  light.colour = {1, 0.5f, 0.25f};
  light.intensity_cd = 800;
  light.casts_shadow = true;
  registry.emplace<Light>(lamp, light);
  // Turned to shine down, and scaled, which says nothing about light.
  const glm::mat4 m = glm::translate(glm::mat4(1.0f), {3, 5, 7}) *
                      glm::rotate(glm::mat4(1.0f), glm::radians(-90.0f), {1, 0, 0}) *
                      glm::scale(glm::mat4(1.0f), glm::vec3(2.5f));
  registry.emplace<WorldTransform>(lamp, m);
  Frame frame;
  extract_lights(registry, frame);
  ASSERT_EQ(frame.lights.size(), 1u);
  EXPECT_EQ(frame.lights[0].position_m, glm::vec3(3, 5, 7));
  EXPECT_LT(glm::distance(frame.lights[0].direction, {0, -1, 0}), 1e-6f);
  EXPECT_EQ(frame.lights[0].intensity, glm::vec3(800, 400, 200));
  EXPECT_EQ(frame.lights[0].kind, LIGHT_SPOT);
  EXPECT_EQ(frame.lights[0].shadow_slot, -1);
  const std::uint64_t version = frame.lights_version;
  registry.get<Light>(lamp).intensity_cd = 20;  // flickers
  extract_lights(registry, frame);
  EXPECT_EQ(frame.lights_version, version);
  registry.get<WorldTransform>(lamp).matrix[3].y = 4;
  extract_lights(registry, frame);
  EXPECT_NE(frame.lights_version, version);
}

}  // namespace
}  // namespace petrichor::test
