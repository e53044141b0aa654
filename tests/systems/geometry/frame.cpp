// The frame's constants, against their definitions.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "systems/frame_gpu.hpp"
#include "systems/frustum.hpp"

namespace petrichor::test {
namespace {

Frame some_frame() {
  Frame frame;
  frame.width = 640;
  frame.height = 360;
  frame.camera.position_m = {1000.0, 20.0, -300.0};
  frame.camera.orientation = glm::angleAxis(0.7f, glm::normalize(glm::vec3(0.2f, 1.0f, -0.1f)));
  frame.camera.vertical_fov_rad = 0.9f;
  frame.camera.near_m = 0.1f;
  return frame;
}

glm::vec2 pixel(const Frame& f, const glm::mat4& m, const glm::vec3& p) {
  const glm::vec4 c = m * glm::vec4(p, 1.0f);
  return (glm::vec2(c) / c.w * 0.5f + 0.5f) * glm::vec2(f.width, f.height);
}

TEST(FrameUniforms, DepthIsReversedAndInfinite) {
  Frame frame = some_frame();
  finish_frame(frame);
  const glm::vec3 forward = frame.camera.orientation * glm::vec3(0, 0, -1);
  for (const float distance : {0.1f, 1.0f, 50.0f, 1e6f}) {
    const glm::vec4 c = frame.uniforms.view_projection * glm::vec4(forward * distance, 1.0f);
    EXPECT_NEAR(c.z / c.w * distance / 0.1f, 1.0f, 1e-5f);
    EXPECT_NEAR(c.x / c.w, 0.0f, 1e-5f);
  }
}

TEST(FrameUniforms, InverseTakesBackWhatTheProjectionDid) {
  Frame frame = some_frame();
  finish_frame(frame);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  for (int i = 0; i < 500; ++i) {
    const float distance = std::exp(5.0f * unit(random)) * 5.0f;
    const glm::vec3 p =
        frame.camera.orientation * glm::vec3(0.8f * unit(random), 0.4f * unit(random), -1.0f) * distance;
    const glm::vec4 c = frame.uniforms.view_projection * glm::vec4(p, 1.0f);
    const glm::vec4 back = frame.uniforms.inverse_view_projection * (c / c.w);
    EXPECT_LT(glm::distance(glm::vec3(back) / back.w, p), 1e-5f * glm::length(p)) << i;
  }
}

TEST(FrameUniforms, LensAndExposureByDefinition) {
  Frame frame = some_frame();
  frame.camera.exposure_ev100 = 3.0f;
  finish_frame(frame);
  // A milliradian off the axis is that share of "pixels per radian".
  const glm::vec3 off = frame.camera.orientation * glm::vec3(std::sin(1e-3f), 0, -std::cos(1e-3f));
  EXPECT_NEAR(pixel(frame, frame.uniforms.view_projection, off).x - 320.0f, 1e-3f * frame.uniforms.lens.z, 2e-4f);
  // EV100 15 is sunlight: its white is 1.2 x 2^15 = 39,322 cd/m2.
  EXPECT_NEAR(exposure_scale(15.0f) * 39321.6f, 1.0f, 1e-5f);
  EXPECT_EQ(frame.uniforms.lens.w, exposure_scale(3.0f));
}

TEST(FrameUniforms, ShutterMatrixIsTheCameraWhenTheShutterOpened) {
  Frame now = some_frame();
  now.camera.velocity_mps = {3, -1, 2};
  now.camera.angular_velocity_radps = {0.3f, -1.5f, 0.2f};
  now.camera.exposure_s = 0.1f;
  finish_frame(now);

  Frame then = now;
  const glm::vec3 moved = now.camera.velocity_mps * now.camera.exposure_s;
  const glm::vec3 turn = now.camera.angular_velocity_radps * now.camera.exposure_s;
  then.camera.position_m -= glm::dvec3(moved);
  then.camera.orientation =
      glm::inverse(glm::angleAxis(glm::length(turn), glm::normalize(turn))) * now.camera.orientation;
  finish_frame(then);

  for (const glm::vec3 local : {glm::vec3(1, 0.5f, -4), glm::vec3(-2, 1, -20), glm::vec3(0, 0, -300)}) {
    const glm::vec3 p = now.camera.orientation * local;  // relative to the camera now
    EXPECT_LT(glm::distance(pixel(now, now.uniforms.shutter_view_projection, p),
                            pixel(then, then.uniforms.view_projection, p + moved)),
              0.01f);
    EXPECT_GT(
        glm::distance(pixel(now, now.uniforms.shutter_view_projection, p), pixel(now, now.uniforms.view_projection, p)),
        5.0f);
  }
  now.camera.velocity_mps = now.camera.angular_velocity_radps = glm::vec3(0);
  finish_frame(now);
  EXPECT_EQ(now.uniforms.shutter_view_projection, now.uniforms.view_projection);
}

TEST(FrameUniforms, RainBeyondTheDrawnDropsIsExtinction) {
  Frame frame = some_frame();
  finish_frame(frame);
  EXPECT_EQ(frame.uniforms.rain, glm::vec4(0.0f));
  frame.rain = FrameRain{};
  frame.rain->rain_mm_per_hour = 50;
  frame.rain->extinction_per_m = 0.0012f;
  frame.rain->drawn_extinction_per_m = 0.0009f;
  frame.rain->fade_start_m = 20;
  frame.rain->drawn_distance_m = 25;
  finish_frame(frame);
  EXPECT_NEAR(frame.uniforms.rain.x + frame.uniforms.rain.z, 0.0012f, 1e-9f);  // beyond: all of it
  EXPECT_NEAR(frame.uniforms.rain.z, 0.0003f, 1e-9f);                          // before: what is never drawn
  EXPECT_EQ(frame.uniforms.rain.y, 22.5f);                                     // the middle of the fade
}

FrameLight lamp(glm::vec3 position, float candela) {
  FrameLight light{};
  light.position_m = position;
  light.direction = {0, -1, 0};
  light.intensity = glm::vec3(candela);
  light.outer_cone_rad = 0.8f;
  light.kind = LIGHT_POINT;
  return light;
}

TEST(VisibleLights, ALightIsCutWhereAWhiteWallHardlyShowsIt) {
  const FrameLight light = lamp({}, 500);
  const float range = light_range_m(light, 3.0f);
  const float wall_cd_m2 = 500.0f / (range * range) / 3.14159265f;
  EXPECT_NEAR(wall_cd_m2 * exposure_scale(3.0f), visible_share, 1e-4f * visible_share + 1e-7f);
  // A darker exposure sees less far: four stops, a quarter of the distance.
  EXPECT_NEAR(light_range_m(light, 7.0f), range / 4.0f, 1e-3f * range);
  FrameLight given = light;
  given.range_m = 12;
  EXPECT_EQ(light_range_m(given, 3.0f), 12.0f);
}

TEST(VisibleLights, OnlyWhatReachesTheFrustumBrightestFirst) {
  Frame frame = some_frame();
  frame.camera.position_m = {0, 0, 0};
  frame.camera.orientation = {1, 0, 0, 0};  // along -z
  frame.lights = {lamp({0, 0, -50}, 100), lamp({0, 0, -5}, 100), lamp({0, 0, 500}, 100),
                  lamp({0, 3, 2}, 50),    lamp({0, 0, -6}, 0),   lamp({0, 0, 0}, 1)};
  frame.lights[5].kind = LIGHT_DIRECTIONAL;
  frame.lights[1].shadow_slot = 7;
  finish_frame(frame);
  const std::vector<LightGpu> lights = visible_lights(frame);
  ASSERT_EQ(lights.size(), 4u);  // not the one far behind, not the dark one
  EXPECT_EQ(frame.uniforms.counts.x, 4u);
  EXPECT_EQ(lights[0].direction_kind.w, static_cast<float>(LIGHT_DIRECTIONAL));
  EXPECT_EQ(lights[1].position_range.z, -5.0f);  // 100 cd / 25 m2
  EXPECT_EQ(lights[1].cone_shadow.z, 7.0f);
  EXPECT_EQ(lights[2].position_range.z, 2.0f) << "50 / 13: behind the camera, but its light falls into the view";
  EXPECT_EQ(lights[3].cone_shadow.z, -1.0f);
}

TEST(VisibleLights, ConeIsKhrLightsPunctual) {
  Frame frame = some_frame();
  frame.camera.position_m = {0, 0, 0};
  frame.camera.orientation = {1, 0, 0, 0};
  frame.lights = {lamp({0, 0, -5}, 100)};
  frame.lights[0].kind = LIGHT_SPOT;
  frame.lights[0].inner_cone_rad = 0.3f;
  finish_frame(frame);
  const glm::vec4 cone = visible_lights(frame)[0].cone_shadow;
  EXPECT_NEAR(std::cos(0.3f) * cone.x + cone.y, 1.0f, 1e-5f);
  EXPECT_NEAR(std::cos(0.8f) * cone.x + cone.y, 0.0f, 1e-5f);
  frame.lights[0].kind = LIGHT_POINT;
  const glm::vec4 round = visible_lights(frame)[0].cone_shadow;
  EXPECT_EQ(round.x, 0.0f);
  EXPECT_EQ(round.y, 1.0f);
}

}  // namespace
}  // namespace petrichor::test
