// Falling snow as it is drawn.
#include <cstring>

#include "engine/core/random.hpp"
#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "fixture.hpp"
#include "systems/rainfall/cone/cone.hpp"

namespace petrichor {
namespace {

class SnowPicture : public SnowTest {};

// The mean over some moments and views that share no flake.
double mean_seen(RainStage& s, const Snowfall& snowfall, SnowView view, int frames, SnowRung rung = SnowRung::field,
                 const glm::vec3& camera_mps = glm::vec3(0.0f)) {
  double sum = 0.0;
  for (int i = 0; i < frames; ++i) {
    view.camera_m = {3.0 + 200.0 * i, 1.7, -8.0};
    Frame frame = snow_frame(view, 11.0 + 0.7 * i);
    frame.number = std::uint64_t(i);
    frame.camera.velocity_mps = camera_mps;
    snow_on(frame, snowfall);
    frame.snow->techniques.set(Effect::snow, rung);
    sum += mean_of(light_of(s, frame)) / frames;
  }
  return sum;
}

double extinction_of(float mm_per_hour) {
  Frame frame = snow_frame({}, 0.0);
  snow_on(frame, snow_of(mm_per_hour));
  return frame.snow->extinction_per_m;
}

TEST_F(SnowPicture, FlakesAndHazeHaveTheSameMeanAtAnyWall) {
  // A frame's own deviation is some 0.1% of the background, most of it from the nearest few flakes; 0.5% is asked for.
  const SnowView view;
  for (const float wall_m : {2.0f, 6.0f, 16.0f}) {
    const auto s = wall(wall_m);
    for (const float rate : {0.3f, 3.0f}) {
      const double truth = expected_transmittance(extinction_of(rate), wall_m, view);
      for (const float drawn_m : {3.0f, 7.0f})
        EXPECT_NEAR(mean_seen(*s, snow_of(rate, drawn_m), view, 5), truth, 0.005)
            << rate << " mm/h, wall " << wall_m << " m, drawn to " << drawn_m << " m";
      EXPECT_NEAR(mean_seen(*s, snow_of(rate, 25.0f, 3000), view, 5), truth, 0.005) << rate << " " << wall_m;
      EXPECT_NEAR(mean_seen(*s, snow_of(rate), view, 1, SnowRung::fog), truth, 0.001) << rate << " " << wall_m;
    }
  }
}

TEST_F(SnowPicture, TheFlakesTakeWhatTheyShould) {
  // The same with a tolerance relative to what the snow takes: of a fifth behind 12 m of heavy snow.
  const SnowView view;
  const auto s = wall(12.0f);
  const double taken = 1.0 - expected_transmittance(extinction_of(3.0f), 12.0, view);
  EXPECT_GT(taken, 0.1);
  EXPECT_NEAR(1.0 - mean_seen(*s, snow_of(3.0f, 14.0f), view, 3), taken, 0.03 * taken);
}

TEST_F(SnowPicture, MeanIsTheSameAtAnyExposureAndForAMovingCamera) {
  const auto s = wall(8.0f);
  for (const float exposure_s : {1.0f / 500, 1.0f / 30, 0.5f}) {
    const SnowView view{.exposure_s = exposure_s};
    const double truth = expected_transmittance(extinction_of(3.0f), 8.0, view);
    EXPECT_NEAR(mean_seen(*s, snow_of(3.0f, 5.0f), view, 5), truth, 0.005) << exposure_s;
  }
  const SnowView view;
  const double truth = expected_transmittance(extinction_of(3.0f), 8.0, view);
  EXPECT_NEAR(mean_seen(*s, snow_of(3.0f, 5.0f), view, 5, SnowRung::field, {10.0f, 0.0f, 0.0f}), truth, 0.005);
}

TEST_F(SnowPicture, RungsGiveWayWithTheSameMean) {
  const SnowView view;
  const auto s = wall(8.0f);
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) {
    SnowView here = view;
    here.camera_m.x += 200.0 * i;
    Frame frame = snow_frame(here, 5.0 + i);
    snow_on(frame, snow_of(3.0f));
    frame.snow->techniques[Effect::snow] = {std::uint8_t(SnowRung::field), std::uint8_t(SnowRung::fog), 0.4f};
    sum += mean_of(light_of(*s, frame)) / 6.0;
  }
  EXPECT_NEAR(sum, expected_transmittance(extinction_of(3.0f), 8.0, view), 0.005);
}

TEST_F(SnowPicture, TheConeSwaysAndKeepsTheMean) {
  // Sway moves what the cone shows to and fro, and adds nothing to it; it is over after 64 s as it began.
  const auto s = wall(30.0f);
  const SnowView view;
  const auto draw = [&](double time_s, float jitter) {
    Frame frame = snow_frame(view, time_s);
    Snowfall snowfall = snow_of(0.5f);
    snowfall.cone_jitter = jitter;
    snow_on(frame, snowfall);
    frame.snow->techniques.set(Effect::snow, SnowRung::double_cone);
    set_cone(*frame.snow, DoubleCone{}, frame.camera, 1.0f / 60.0f, 3.0);  // its scroll stands still
    return light_of(*s, frame);
  };
  const auto still = draw(7.0, 0.0f), start = draw(7.0, 1.0f), later = draw(7.3, 1.0f);
  EXPECT_EQ(still, draw(7.3, 0.0f));
  EXPECT_GT(difference(start, still), 0.0);
  EXPECT_GT(difference(start, later), 0.2 * difference(start, still));
  EXPECT_LT(difference(start, draw(7.0 + snow_clock_s, 1.0f)), 1e-3 * difference(start, later));
  double mean = 0.0, mean_still = 0.0;
  for (int i = 0; i < 16; ++i) {
    mean += mean_of(draw(0.37 * i, 1.0f)) / 16.0;
    mean_still += mean_of(still) / 16.0;
  }
  EXPECT_NEAR(mean, mean_still, 0.0005);
}

TEST_F(SnowPicture, LampsGiveFlakesWhatTheyGiveHaze) {
  // In front of a dark wall all light is that of flakes: as much as the airlight of their haze, by the same phase.
  const auto s = wall(9.5f, 0.0f);
  const SnowView view;
  const auto mean = [&](SnowRung rung, int frames) {
    double sum = 0.0;
    for (int i = 0; i < frames; ++i) {
      SnowView here = view;
      here.camera_m.x += 100.0 * i;
      Frame frame = snow_frame(here, 5.0 + i);
      for (const glm::vec3 at : {glm::vec3(-2.0f, 1.5f, -7.0f), glm::vec3(2.5f, -0.5f, -9.0f)}) {
        FrameLight lamp{};
        lamp.position_m = glm::vec3(here.camera_m) + at;
        lamp.direction = {0.0f, -1.0f, 0.0f};
        lamp.intensity = glm::vec3(200.0f);
        lamp.source_radius_m = 0.1f;
        lamp.kind = LIGHT_POINT;
        lamp.lights_rain = true;
        frame.lights.push_back(lamp);
      }
      snow_on(frame, snow_of(3.0f, 11.0f));
      frame.snow->techniques.set(Effect::snow, rung);
      sum += mean_of(light_of(*s, frame)) / frames;
    }
    return sum;
  };
  const double haze = mean(SnowRung::fog, 1), flakes = mean(SnowRung::field, 4);
  EXPECT_GT(haze, 0.0);
  // 20% of the light comes from within half a metre of the lamps, where few flakes are at a time.
  EXPECT_NEAR(flakes / haze, 1.0, 0.12);
}

TEST_F(SnowPicture, SameFrameSameBytes) {
  const auto draw = [&](RainStage& s, double time_s) {
    Frame frame = snow_frame({}, time_s);
    FrameLight lamp{};
    lamp.position_m = {3.5f, 2.0f, -12.0f};
    lamp.direction = {0.0f, -1.0f, 0.0f};
    lamp.intensity = glm::vec3(300.0f);
    lamp.source_radius_m = 0.1f;
    lamp.kind = LIGHT_POINT;
    lamp.lights_rain = true;
    frame.lights.push_back(lamp);
    snow_on(frame, snow_of(2.0f));
    EXPECT_TRUE(s.draw(frame));
    return s.read_picture();
  };
  const auto a = stage({}), b = stage({});
  draw(*a, 3.0);
  draw(*a, 900.0);
  const auto jumped = draw(*a, 15.0), fresh = draw(*b, 15.0);
  EXPECT_EQ(jumped, fresh);
  EXPECT_NE(draw(*b, 15.5), fresh);
}

TEST_F(SnowPicture, FlakesKeepTheirIdentity) {
  // What differs between two pictures goes with the time between them, down to a ten-thousandth of a second: nobody
  // pops in or out, also where the clock of the sway wraps, at the end of the fade and under a budget.
  const auto s = wall(8.0f);
  for (const int budget : {400'000'000, 2000}) {
    const auto at = [&](double time_s) {
      Frame frame = snow_frame({.exposure_s = 0.0f}, time_s);
      snow_on(frame, snow_of(2.0f, 6.0f, budget));
      return light_of(*s, frame);
    };
    for (const double time_s : {17.3, snow_clock_s}) {
      const auto before = at(time_s - 0.5e-4);
      const double small = difference(before, at(time_s + 0.5e-4)), medium = difference(before, at(time_s + 9.5e-4)),
                   other = difference(before, at(time_s + 5.0));
      EXPECT_GT(other, 1e-4);
      EXPECT_GT(medium, 0.0);
      // A thousandth of a second is 1 to 2 mm of fall, a tenth to a third of the smallest pixels that a flake covers.
      EXPECT_LT(medium, 0.25 * other) << time_s << " " << budget;
      // Rounding by chance (1/4096 of a unit of depth a pixel and flake) is what is left.
      EXPECT_LT(small, 0.25 * medium + 0.02 * other) << time_s << " " << budget;
    }
  }
}

TEST_F(SnowPicture, SwayIsBoundedAndOfTheRightPace) {
  ShaderLibrary library;
  const auto program = library.load({{"tests/systems/rainfall/snow_gl/flake_ask.comp.glsl"}, {}});
  ASSERT_TRUE(program) << program.error().message;
  constexpr std::uint32_t flakes = 512, times = 64;
  std::vector<glm::uvec4> asked;
  for (std::uint32_t i = 0; i < flakes; ++i)
    for (std::uint32_t t = 0; t < times; ++t) {
      const float before_s = static_cast<float>(t) / 16.0f;  // two turns and more
      std::uint32_t bits;
      std::memcpy(&bits, &before_s, 4);
      asked.push_back({random_bits(glm::uvec4(i, 1, 2, 3)), bits, 0, 0});
    }
  constexpr float diameter = 0.005f;
  const auto ask = [&](float clock_s) {
    Buffer in = make_buffer(asked.size() * 16, asked.data()), out = make_buffer(asked.size() * 32);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, in.id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 8, out.id);
    (*program)->use();
    (*program)->set("diameter", diameter);
    (*program)->set("sway", 1.0f);
    (*program)->set("clock_s", clock_s);
    (*program)->dispatch(static_cast<int>(asked.size()));
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    std::vector<glm::vec4> got(asked.size() * 2);
    read_buffer(out, got.data(), got.size() * 16);
    return got;
  };
  const auto got = ask(40.0f);
  glm::dvec3 mean(0.0);
  double tumble = 0.0, size = 0.0, slowest = 1e9, fastest = 0.0, widest = 0.0, quickest = 0.0;
  for (std::uint32_t i = 0; i < flakes; ++i) {
    double radius = 0.0;
    for (std::uint32_t t = 0; t < times; ++t) {
      const std::size_t at = 2 * (std::size_t(i) * times + t);
      const glm::vec3 sway(got[at]);
      EXPECT_LE(glm::length(sway), 10.0f * diameter * 1.0001f);
      EXPECT_EQ(sway.y, 0.0f);  // across the fall: it takes no water from anywhere
      mean += glm::dvec3(sway) / double(flakes * times);
      radius = std::max(radius, double(glm::length(sway)));
      tumble += got[at + 1].x / double(flakes * times);
      size += got[at + 1].y / double(flakes * times);
    }
    const double hz = got[2 * std::size_t(i) * times].w;
    slowest = std::min(slowest, hz), fastest = std::max(fastest, hz);
    EXPECT_EQ(hz * snow_clock_s, std::round(hz * snow_clock_s));
    EXPECT_GE(radius, 0.6 * diameter);  // the samples may miss the tips of the ellipse
    widest = std::max(widest, radius);
    quickest = std::max(quickest, 2.0 * M_PI * hz * radius);
  }
  EXPECT_GE(slowest, 0.5);
  EXPECT_LE(fastest, 3.0);
  EXPECT_LT(slowest, 0.6);
  EXPECT_GT(fastest, 2.6);
  EXPECT_GT(widest, 6.0 * diameter);
  EXPECT_LT(quickest, 1.03);  // the fall speed of that size
  EXPECT_LT(glm::length(mean), 0.15 * diameter);
  EXPECT_NEAR(tumble, 1.0, 0.02);
  EXPECT_NEAR(size, 1.0, 0.02);
  // The clock wraps without a jump.
  const auto start = ask(0.0f), wrapped = ask(static_cast<float>(snow_clock_s));
  for (std::size_t i = 0; i < start.size(); i += 2)
    EXPECT_LT(glm::length(glm::vec3(start[i]) - glm::vec3(wrapped[i])), 1e-3f * diameter);
}

TEST_F(SnowPicture, NoSnowUnderARoof) {
  StageSet set;
  set.present = false;
  set.wall_cd_m2 = glm::vec3(1.0f);
  set.wall_distance_m = 12.0f;
  set.wall_hides = set.map = true;
  set.roof_m = 6.0f;  // over all places left of the camera, above what it sees
  const auto s = stage(set);
  const SnowView view;
  Frame frame = snow_frame(view, 5.0);
  snow_on(frame, snow_of(3.0f));
  const auto light = light_of(*s, frame);
  int dry = 0, snowy = 0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width - 1; ++x) {
      if (std::abs(x - view.width / 2) < 12) continue;  // a near flake in the open reaches over
      const float* p = &light[4 * (std::size_t(y) * view.width + x)];
      (x < view.width / 2 ? dry : snowy) += std::abs(p[0] - p[4]) > 2e-3f;
    }
  EXPECT_EQ(dry, 0);
  EXPECT_GT(snowy, 1000);
}

TEST_F(SnowPicture, NoSnowNoPass) {
  const auto s = wall(12.0f);
  Frame frame = snow_frame({}, 5.0);
  snow_on(frame, snow_of(1.0f));
  light_of(*s, frame);
  EXPECT_GT(snow_stats(frame).flakes_drawn, 0u);
  // Haze alone: the field's passes rest too.
  frame.number = 1;
  frame.snow->techniques.set(Effect::snow, SnowRung::fog);
  light_of(*s, frame);
  EXPECT_EQ(snow_stats(frame).flakes_drawn, 0u);
  frame.snow.reset();
  frame.number = 2;
  const auto light = light_of(*s, frame);
  EXPECT_EQ(snow_stats(frame).flakes_drawn, 0u);
  for (const PassReport& pass : s->report()) EXPECT_TRUE(pass.culled || !pass.name.starts_with("snow_")) << pass.name;
  for (const float v : light) EXPECT_EQ(v, 1.0f);
}

TEST_F(SnowPicture, DrawsAsManyFlakesAsExpected) {
  StageSet set;
  set.present = false;
  const auto s = stage(set);
  Frame frame = snow_frame({.exposure_s = 0.0f}, 4.0);
  snow_on(frame, snow_of(1.0f, 25.0f, 30'000));
  light_of(*s, frame);
  // The budget counts each by its opacity; all in the fade are drawn. So are those up to two pixels out of the picture.
  const double opacity = (1.0 - std::pow(0.9, 4)) / 0.4, margin = 164.0 * 94.0 / (160.0 * 90.0);
  EXPECT_NEAR(snow_stats(frame).flakes_drawn, 30'000.0 / opacity * margin, 0.04 * 30'000.0);
}

}  // namespace
}  // namespace petrichor
