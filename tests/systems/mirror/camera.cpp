// The mirrored camera, without OpenGL: where mirror images stand, and what the clip plane keeps.
#include "systems/mirror/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "systems/frame_gpu.hpp"
#include "systems/mirror/extract.hpp"
#include "systems/mirror/mirror.hpp"
#include "systems/puddle_frame.hpp"

namespace petrichor {
namespace {

struct Case {
  FrameCamera camera;
  FrameMirrors::Plane plane;
  double aspect = 1.7;
};

Case random_case(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  Case c;
  c.camera.orientation = glm::normalize(glm::quat(unit(random), unit(random), unit(random), unit(random)));
  c.camera.vertical_fov_rad = 0.9f + 0.5f * unit(random);
  c.plane.normal = glm::normalize(glm::vec3(unit(random), unit(random), unit(random)) + 1e-3f);
  c.plane.eye_m = std::exp(2.0f * unit(random));
  return c;
}

// The ray from the eye that a flat mirror sends to a place meets the plane where the eye's straight line to the place's
// mirror image does. It must be seen there, and nowhere else.
TEST(MirrorCamera, ImagesStandWhereRaysMeetThePlane) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  int seen = 0;
  for (int i = 0; i < 4000; ++i) {
    const Case c = random_case(random);
    const glm::dmat4 clip = mirrored_clip(c.camera, c.aspect, c.plane);
    const glm::vec3 n = c.plane.normal;
    const glm::vec3 place = glm::vec3(unit(random), unit(random), unit(random)) * 30.0f;
    const float height = glm::dot(n, place) + c.plane.eye_m;
    if (height < 0.01f) continue;
    const glm::vec3 image = place - 2.0f * height * n;
    const glm::vec3 on = image * (c.plane.eye_m / (c.plane.eye_m + height));
    const glm::vec4 direct =
        view_projection_of(c.camera.orientation, c.camera.vertical_fov_rad, static_cast<float>(c.aspect), 0.05f) *
        glm::vec4(on, 1.0f);
    if (direct.w < 0.05f) continue;
    const glm::dvec4 mirrored = clip * glm::dvec4(place, 1.0);
    ASSERT_GT(mirrored.w, 0.0);
    // A hundredth of a pixel of a 4096 pixel picture.
    const double tolerance = 2.0 * 0.01 / 4096.0 * (1.0 + std::abs(double(direct.x / direct.w)));
    EXPECT_NEAR(mirrored.x / mirrored.w * double(MIRROR_GUARD), -double(direct.x / direct.w), 8 * tolerance);
    EXPECT_NEAR(mirrored.y / mirrored.w * double(MIRROR_GUARD), double(direct.y / direct.w), 8 * tolerance);
    ++seen;
  }
  EXPECT_GT(seen, 500);
}

// Depth is 1 on the plane, above 1 (clipped) behind it, and falls along every ray of the picture without reaching 0.
TEST(MirrorCamera, TheClipPlaneIsTheMirror) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int rays = 0;
  for (int i = 0; i < 4000; ++i) {
    const Case c = random_case(random);
    const glm::dmat4 clip = mirrored_clip(c.camera, c.aspect, c.plane), back = glm::inverse(clip);
    const glm::dvec3 n(c.plane.normal), eye = -2.0 * double(c.plane.eye_m) * n;
    const glm::dvec4 at = back * glm::dvec4(unit(random), unit(random), 1.0, 1.0);
    const glm::dvec3 on = glm::dvec3(at) / at.w;
    const glm::dvec3 ray = glm::normalize(on - eye);
    if (at.w <= 0.0 || glm::dot(ray, n) < 1e-3) continue;  // this ray of the picture does not meet the mirror
    EXPECT_NEAR(glm::dot(n, on) + double(c.plane.eye_m), 0.0, 1e-6 * (1.0 + glm::length(on)));
    double last = 1.0 + 1e-9;
    for (const double way : {1e-3, 0.1, 1.0, 10.0, 100.0, 1000.0, 1e5}) {
      const glm::dvec4 q = clip * glm::dvec4(on + ray * way, 1.0);
      const double depth = q.z / q.w;
      EXPECT_LT(depth, last) << way;
      EXPECT_GT(depth, 0.0) << way;
      last = depth;
    }
    const glm::dvec4 behind = clip * glm::dvec4(on - ray * std::min(1e-3, 0.1 * glm::length(on - eye)), 1.0);
    EXPECT_GT(behind.z, behind.w);
    ++rays;
  }
  EXPECT_GT(rays, 500);
}

// Turned left for right: a triangle that faces the mirrored eye keeps its winding, so that culling needs no care.
TEST(MirrorCamera, TrianglesKeepTheirWinding) {
  Case c;
  c.plane.eye_m = 1.5f;
  c.camera.orientation = glm::quat(glm::vec3(-0.4f, 0, 0));
  const glm::dmat4 clip = mirrored_clip(c.camera, c.aspect, c.plane);
  const auto corner = [&](double x, double y) {
    const glm::dvec4 q = clip * glm::dvec4(x, y, -6.0, 1.0);
    return glm::dvec2(q) / q.w;
  };
  // Counter-clockwise as seen from +z, where both eyes are.
  const glm::dvec2 a = corner(0, 0), b = corner(1, 0), d = corner(0, 1);
  EXPECT_GT((b - a).x * (d - a).y - (b - a).y * (d - a).x, 0.0);
}

TEST(MirrorCamera, OnScreenIsTheAreaThatIsSeen) {
  const glm::mat4 clip = view_projection_of(glm::quat(1, 0, 0, 0), 1.57079633f, 1.0f, 0.05f);
  const auto square = [&](float x, float y, float half, float z) {
    const glm::vec3 corners[4] = {
        {x - half, y - half, z}, {x + half, y - half, z}, {x + half, y + half, z}, {x - half, y + half, z}};
    return on_screen(clip, corners);
  };
  EXPECT_NEAR(square(0, 0, 0.5f, -2).share, 0.0625f, 1e-5f);
  EXPECT_NEAR(square(2, 0, 1, -2).share, 0.125f, 1e-5f);  // half of it is out of view
  EXPECT_EQ(square(0, 0, 1, 2).share, 0.0f);              // behind
  EXPECT_NEAR(square(0, 0, 100, -2).share, 1.0f, 1e-5f);
  const glm::vec3 floor[4] = {{-100, -1, 100}, {100, -1, 100}, {100, -1, -1e5f}, {-100, -1, -1e5f}};
  EXPECT_NEAR(on_screen(clip, floor).share, 0.5f, 0.01f);  // through the eye's own plane, out to the horizon
}

Frame frame_over(std::initializer_list<std::pair<float, float>> level_and_width, float eye_m) {
  Frame f;
  f.width = 160;
  f.height = 90;
  f.camera.position_m = {0, eye_m, 0};
  f.camera.orientation = glm::quat(glm::vec3(-0.3f, 0, 0));
  auto puddles = std::make_shared<FramePuddles>();
  float x = -3.0f;
  for (const auto& [level, width] : level_and_width) {
    FramePuddles::Puddle p;
    p.world_from_puddle[3] = {x, level, -6, 1};
    p.half_size_m = {width, 1.0f};
    p.level_m = p.depth_m = 0.02f;
    puddles->puddles.push_back(p);
    x += 3.0f;
  }
  f.puddles = puddles;
  return f;
}

TEST(MirrorChoice, WaterIsAtTheLevelOfMostPuddlesInView) {
  const auto plane = water_plane(frame_over({{0.02f, 1.0f}, {0.0f, 1.0f}, {1.3f, 0.4f}}, 1.6f));
  ASSERT_TRUE(plane);
  EXPECT_GT(plane->eye_m, 1.58f);  // between the two of the street; the basin up on the wall does not count
  EXPECT_LT(plane->eye_m, 1.6f);
  EXPECT_GT(plane->share, 0.9f);
  Frame dry = frame_over({{0.0f, 1.0f}}, 1.6f);
  auto puddles = std::make_shared<FramePuddles>(*dry.puddles);
  puddles->puddles[0].level_m = 0.0f;
  dry.puddles = puddles;
  EXPECT_FALSE(water_plane(dry));
  dry.rain.emplace();
  dry.rain->rain_mm_per_hour = 5.0f;  // wet ground at the height of the hollow's brim
  const auto street = water_plane(dry);
  ASSERT_TRUE(street);
  EXPECT_NEAR(street->eye_m, 1.6f, 1e-4f);
  EXPECT_GT(street->coverage, 0.3f);
  EXPECT_FALSE(water_plane(frame_over({{3.0f, 1.0f}}, 1.6f))) << "seen from below";
}

TEST(MirrorChoice, PanesOfOneFrontCountTogether) {
  Frame f;
  f.width = 160;
  f.height = 90;
  const auto pane = [](float x, float z, float width) {
    MirrorPane p;
    p.world[3] = {x, 0, z, 1};
    p.size_m = {width, 1.0f};
    return p;
  };
  // Three small ones in one plane cover more than a large one farther off.
  const MirrorPane all[] = {pane(0, -8, 2.5f), pane(-1.2f, -5, 0.7f), pane(0, -5, 0.7f), pane(1.2f, -5, 0.7f)};
  const auto plane = pane_plane(f, all);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->eye_m, 5.0f, 1e-4f);
  EXPECT_NEAR(plane->normal.z, 1.0f, 1e-5f);
  f.camera.position_m = {0, 0, -6};  // between them, looking at the far one's front and with the near ones behind
  const auto far = pane_plane(f, all);
  ASSERT_TRUE(far);
  EXPECT_NEAR(far->eye_m, 2.0f, 1e-4f);
  f.camera.position_m = {0, 0, -20};
  EXPECT_FALSE(pane_plane(f, all));
}

TEST(MirrorChoice, NearestProbesGiveWayWithoutAJump) {
  Frame f;
  f.width = 160;
  f.height = 90;
  std::vector<FrameMirrors::Probe> all;
  for (int i = 0; i < 7; ++i) {
    FrameMirrors::Probe p;
    p.place_m = {0.0, 0.0, -5.0 - 3.0 * i};
    p.entity = static_cast<std::uint32_t>(i);
    all.push_back(p);
  }
  // What object 4 mirrors of its own, as the eye comes nearer: from nothing, in small steps.
  double last = 0.0;
  for (double z = 0.0; z > -13.0; z -= 0.05) {
    f.camera.position_m.z = z;
    double now = 0.0;
    for (const auto& p : nearest_probes(f, all))
      if (p.entity == 4u) now = static_cast<double>(p.share);
    EXPECT_LT(std::abs(now - last), 0.15) << z;
    last = now;
  }
  EXPECT_EQ(last, 1.0);
  const auto behind = nearest_probes(f, {{{0, 0, 10}, 2.0f}});
  ASSERT_EQ(behind.size(), 1u);
  EXPECT_EQ(behind[0].coverage, 0.0f);
  EXPECT_TRUE(nearest_probes(f, {{{0, 0, -100}, 2.0f}}).empty());
}

}  // namespace
}  // namespace petrichor
