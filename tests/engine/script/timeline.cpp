// Time: waits, tweens, paths and events give the same world whatever the steps.

#include <unistd.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "engine/script/path.hpp"
#include "tests/engine/script/fixture.hpp"

namespace petrichor {
namespace {

class TimelineTest : public ScriptTest {
 protected:
  void advance(double time_s) {
    const auto result = host().advance(time_s);
    EXPECT_TRUE(result) << result.error().message;
  }
  Emitter& emitter() {
    Emitter* found = nullptr;
    registry.view<Emitter>().each([&](Entity, Emitter& e) { found = &e; });
    return *found;
  }
  // A world made anew by the script, brought to time_s by steps of step_s (the last one shorter).
  void play(const std::string& text, double step_s, double time_s) {
    made.reset();
    registry.clear();
    printed.clear();
    expect_ok(text);
    for (double t = 0; t < time_s; t += step_s) advance(t);
    advance(time_s);
  }
};

TEST_F(TimelineTest, TweensAreExactAtAnyStep) {
  const std::string text =
      "local rain = world.spawn{emitter={rain_mm_per_hour=2}}\n"
      "timeline(function() wait(1.5) tween(rain.emitter, 'rain_mm_per_hour', 50, 4) print(world.time()) "
      "tween(rain.emitter, 'rain_mm_per_hour', 10, 1) end)";
  for (const double step_s : {1.0 / 60, 1.0 / 24, 0.37, 1.0, 7.0}) {
    play(text, step_s, 3.5);
    EXPECT_FLOAT_EQ(emitter().rain_mm_per_hour, 26.0f) << step_s;  // half way
    advance(5.5);
    EXPECT_EQ(emitter().rain_mm_per_hour, 50.0f) << step_s;
    EXPECT_EQ(printed, std::vector<std::string>{"5.5"}) << step_s;
    advance(6.25);
    EXPECT_FLOAT_EQ(emitter().rain_mm_per_hour, 20.0f) << step_s;
    advance(100.0);
    EXPECT_EQ(emitter().rain_mm_per_hour, 10.0f) << step_s;
    EXPECT_FALSE(host().busy());
  }
}

TEST_F(TimelineTest, StateDoesNotDependOnTheSteps) {
  const std::string text = R"(
local rain = world.spawn{emitter={}, wind={}, transform={}, light={}}
timeline(function() for i = 1, 20 do wait(0.1) rain.wind.gust_mps = i end end)
go(function() tween(rain.emitter, 'rain_mm_per_hour', 40, 1.7, 'smooth') tween(rain.emitter, 'rain_mm_per_hour', 0, 1.1, 'in') end)
go(function() wait(0.4) tween(rain.wind, 'velocity_mps', {3, 0, 1}, 1.9, 'out') end)
go(function() wait(0.3) tween(rain.transform, 'orientation', euler(90, 0, 0), 2) end)
go(function() tween(rain.light, 'colour', {r=0.5, g=0, b=0.25}, 1) tween(rain.emitter, 'maximum_drops', 1000, 1) end)
go(function() wait(0.7) rain.transform.position_m = {rain.emitter.rain_mm_per_hour, rain.wind.gust_mps, 0} end))";
  std::vector<float> first;
  for (const double step_s : {1.0 / 240, 1.0 / 60, 0.5, 2.3}) {
    play(text, step_s, 2.3);
    std::vector<float> now;
    registry.view<Emitter, Wind, Transform, Light>().each([&](Entity, Emitter& e, Wind& w, Transform& t, Light& l) {
      now = {e.rain_mm_per_hour, static_cast<float>(e.maximum_drops),
             w.gust_mps,         w.velocity_mps.x,
             w.velocity_mps.z,   t.orientation.w,
             t.orientation.y,    t.position_m.x,
             t.position_m.y,     l.colour.r,
             l.colour.b};
    });
    if (first.empty()) first = now;
    EXPECT_EQ(now, first) << step_s;
  }
  EXPECT_FLOAT_EQ(first[5], std::cos(glm::radians(45.0f)));  // a quarter turn about y
  EXPECT_FLOAT_EQ(first[6], std::sin(glm::radians(45.0f)));
  EXPECT_FLOAT_EQ(first[8], 6.0f + 1.0f);  // read at 0.7 s, the seventh wait done
}

TEST_F(TimelineTest, OrderIsWakeTimeThenCreation) {
  play(
      "for i, t in ipairs{0.3, 0.1, 0.2, 0.1, 0.3} do go(function() wait(t) print(i .. ' at ' .. world.time()) end) "
      "end",
      1.0, 1.0);
  EXPECT_EQ(printed, (std::vector<std::string>{"2 at 0.1", "4 at 0.1", "3 at 0.2", "1 at 0.3", "5 at 0.3"}));
}

TEST_F(TimelineTest, WaitWithoutATimeIsOneStep) {
  play("go(function() while true do wait() print(world.time()) end end)", 0.25, 1.0);
  EXPECT_EQ(printed, (std::vector<std::string>{"0.25", "0.5", "0.75", "1.0"}));
}

TEST_F(TimelineTest, TheScriptItselfMayWait) {
  play(
      "print(world.time()) wait(2) print(world.time()) wait_until(5) print(world.time()) wait_until(1) print('still ' "
      ".. world.time())",
      3.0, 9.0);
  EXPECT_EQ(printed, (std::vector<std::string>{"0.0", "2.0", "5.0", "still 5.0"}));
}

TEST_F(TimelineTest, ALaterTweenTakesTheFieldOver) {
  play(
      "rain = world.spawn{emitter={}} go(function() tween(rain.emitter, 'rain_mm_per_hour', 100, 10) end) "
      "go(function() wait(1) tween(rain.emitter, 'rain_mm_per_hour', 0, 1) end)",
      0.1, 1.5);
  EXPECT_NEAR(emitter().rain_mm_per_hour, 5.0f, 1e-4);
  advance(5.0);
  EXPECT_EQ(emitter().rain_mm_per_hour, 0.0f);
}

TEST_F(TimelineTest, EasingsStartAndEndExactly) {
  using script::ease;
  using script::Easing;
  for (const Easing easing : {Easing::linear, Easing::smooth, Easing::in, Easing::out}) {
    EXPECT_EQ(ease(easing, 0.0), 0.0);
    EXPECT_EQ(ease(easing, 1.0), 1.0);
    EXPECT_EQ(ease(easing, 2.0), 1.0);
    for (int i = 0; i < 100; ++i) EXPECT_LE(ease(easing, i / 100.0), ease(easing, (i + 1) / 100.0));
  }
  EXPECT_EQ(ease(Easing::smooth, 0.5), 0.5);
  EXPECT_LT(ease(Easing::in, 0.5), 0.5);
  EXPECT_GT(ease(Easing::out, 0.5), 0.5);
}

TEST_F(TimelineTest, TweenErrorsAreToldAtTheLine) {
  const std::string spawn = "local e = world.spawn{emitter={rain_mm_per_hour=3}, name='rain'}\n";
  EXPECT_CONTAINS(error_of(spawn + "tween(e.emitter, 'rain_mm_per_hour', 1e9, 1)"), "test.lua:2:");
  EXPECT_EQ(emitter().rain_mm_per_hour, 3.0f);
  EXPECT_CONTAINS(error_of(spawn + "tween(e.emitter, 'rain_mm_per_hour', 0/0, 1)"), "finite");
  EXPECT_CONTAINS(error_of(spawn + "tween(e.emitter, 'rain_mm_per_hour', {1}, 1)"), "rain_mm_per_hour");
  EXPECT_CONTAINS(error_of(spawn + "tween(e.emitter, 'rain_mm_per_hou', 1, 1)"), "rain_mm_per_hour");
  EXPECT_CONTAINS(error_of(spawn + "tween(e.emitter, 'drop_sizes', 'gamma', 1)"), "in between");
  EXPECT_CONTAINS(error_of(spawn + "tween(e, 'rain_mm_per_hour', 1, 1)"), "component");
  EXPECT_CONTAINS(error_of(spawn + "tween(e.emitter, 'rain_mm_per_hour', 1, -1)"), "tween");
  EXPECT_CONTAINS(error_of(spawn + "tween(e.emitter, 'rain_mm_per_hour', 1, 1, 'smoth')"), "smooth");
  EXPECT_CONTAINS(error_of("wait(0/0)"), "wait");
  EXPECT_CONTAINS(error_of("coroutine.wrap(function() wait(1) end)()"), "coroutine of your own");
  EXPECT_CONTAINS(error_of("table.sort({1, 2}, function() wait(1) end)"), "sort");
  EXPECT_CONTAINS(error_of("coroutine.yield()"), "yield");
}

TEST_F(TimelineTest, TweeningADestroyedEntityEndsTheStory) {
  expect_ok(
      "e = world.spawn{emitter={}}\ngo(function()\n  tween(e.emitter, 'rain_mm_per_hour', 9, 5)\nend)\ngo(function() "
      "wait(1) e:destroy() end)");
  advance(0.5);
  const auto result = host().advance(2.0);
  ASSERT_FALSE(result);
  EXPECT_CONTAINS(result.error().message, "test.lua:3: the entity whose emitter.rain_mm_per_hour moves was destroyed");
  EXPECT_FALSE(host().busy());
}

TEST_F(TimelineTest, AFailingStoryDoesNotStopTheOthers) {
  expect_ok(
      "go(function() wait(1)\nerror('first') end) go(function() wait(1) print('second') wait(1) print('third') end)");
  advance(0.0);
  const auto result = host().advance(1.0);
  ASSERT_FALSE(result);
  EXPECT_CONTAINS(result.error().message, "test.lua:2: first");
  EXPECT_CONTAINS(result.error().message, "stack traceback:");
  EXPECT_EQ(printed, std::vector<std::string>{"second"});
  advance(2.0);
  EXPECT_EQ(printed.back(), "third");
}

TEST_F(TimelineTest, AnEndlessStoryIsStoppedAndTheOthersGoOn) {
  options.limits.step_instructions = 1'000'000;
  expect_ok(
      "go(function() wait(1) while true do pcall(function() while true do end end) end end) "
      "go(function() wait(1) print('second') end) go(function() while true do wait(1e-7) end end)");
  advance(0.0);
  auto result = host().advance(1.0);
  ASSERT_FALSE(result);  // the many tiny waits
  EXPECT_CONTAINS(result.error().message, "million instructions");
  result = host().advance(1.0);
  ASSERT_FALSE(result);  // the endless loop
  EXPECT_CONTAINS(result.error().message, "million instructions");
  advance(1.0);
  EXPECT_EQ(printed, std::vector<std::string>{"second"});
  EXPECT_FALSE(host().busy());
}

TEST_F(TimelineTest, TheTimelineOwnsItsCoroutines) {
  expect_ok("go(function() co = coroutine.running() wait(5) print('woke at ' .. world.time()) end)");
  advance(0.0);
  EXPECT_CONTAINS(error_of("print(coroutine.resume(co))"), "belongs to the timeline");
  EXPECT_CONTAINS(error_of("coroutine.close(co)"), "belongs to the timeline");
  advance(5.0);
  EXPECT_EQ(printed.back(), "woke at 5.0");
}

TEST_F(TimelineTest, PcallMayWait) {
  play("go(function() print(pcall(function() wait(1) error('late', 0) end)) wait(1) print(world.time()) end)", 0.5,
       3.0);
  EXPECT_EQ(printed, (std::vector<std::string>{"false\tlate", "2.0"}));
}

TEST_F(TimelineTest, EventsReachWhoListens) {
  expect_ok(
      "local h = on('bell', function(n) wait(0.5) print('heard', n, world.time()) end)\n"
      "on('off', function() h:off() end)\n"
      "go(function() while true do print('got', wait_for('bell')) end end)\n"
      "go(function() wait(1) print(emit('bell', 7), emit('nobody')) end)");
  advance(0.0);
  advance(2.0);
  EXPECT_EQ(printed, (std::vector<std::string>{"2\t0", "got\t7", "heard\t7\t1.5"}));
  printed.clear();
  host().emit("bell", 8);
  advance(3.0);
  advance(4.0);
  EXPECT_EQ(printed, (std::vector<std::string>{"got\t8", "heard\t8\t3.5"}));
  printed.clear();
  host().emit("off");
  advance(4.5);
  host().emit("bell", nlohmann::json{{"where", "tower"}});
  advance(5.0);
  EXPECT_EQ(printed.size(), 1u);
}

TEST_F(TimelineTest, TimeDoesNotGoBack) {
  expect_ok("");
  advance(1.0);
  advance(1.0);
  EXPECT_FALSE(host().advance(0.5));
  EXPECT_FALSE(host().advance(std::nan("")));
}

// ---- paths ------------------------------------------------------------------------------------------------

TEST_F(TimelineTest, SplinesPassTheirPointsSmoothly) {
  const script::Spline spline{{0, 1, 4, 5}, {{0, 0, 0}, {1, 2, 0}, {7, 2, 1}, {8, 0, 1}}};
  for (std::size_t i = 0; i < spline.points.size(); ++i) EXPECT_EQ(spline.at(spline.times_s[i]), spline.points[i]);
  EXPECT_EQ(spline.at(-1), spline.points.front());
  EXPECT_EQ(spline.at(9), spline.points.back());
  // The velocity is continuous at the knots: two one-sided differences agree to the step's order.
  const double h = 1e-5;
  for (const double t : {1.0, 4.0}) {
    const glm::dvec3 before = (spline.at(t) - spline.at(t - h)) / h;
    const glm::dvec3 after = (spline.at(t + h) - spline.at(t)) / h;
    EXPECT_LT(glm::length(after - before), 1e-3);
  }
  // A straight line at even speed stays one, whatever the knots.
  const script::Spline line{{0, 1, 4}, {{0, 0, 0}, {1, 0, 0}, {4, 0, 0}}};
  for (double t = 0; t <= 4; t += 0.1) EXPECT_NEAR(line.at(t).x, t, 1e-12);
}

TEST_F(TimelineTest, CameraPathsAreAFunctionOfTime) {
  const std::string text =
      "local c = world.spawn{camera={}}\ngo(function() wait(1) camera.path{\n"
      "{time_s=0, position={0, 1.7, 10}, target={0, 1.7, 0}, fov=50},\n"
      "{time_s=2, position={1, 1.7, 6}, target={0, 2, 0}, fov=40},\n"
      "{time_s=5, position={0, 1.7, 2}, target={0, 3, 0}, fov=60}} print('through', world.time()) end)";
  std::vector<float> first;
  for (const double step_s : {1.0 / 24, 1.0 / 60, 4.3}) {
    play(text, step_s, 4.3);
    registry.view<Camera, Transform>().each([&](Entity, Camera& c, Transform& t) {
      const std::vector<float> now{c.vertical_fov_deg, t.position_m.x,  t.position_m.y,  t.position_m.z,
                                   t.orientation.x,    t.orientation.y, t.orientation.z, t.orientation.w};
      if (first.empty()) first = now;
      EXPECT_EQ(now, first) << step_s;
      EXPECT_NEAR(t.position_m.y, 1.7f, 1e-6);
      // It looks at the target: the spline of the targets at the same time.
      const script::Spline targets{{0, 2, 5}, {{0, 1.7, 0}, {0, 2, 0}, {0, 3, 0}}};
      const glm::vec3 wanted = glm::normalize(glm::vec3(targets.at(3.3)) - t.position_m);
      EXPECT_LT(glm::length(t.orientation * glm::vec3(0, 0, -1) - wanted), 1e-5f);
    });
    advance(6.0);
    EXPECT_EQ(printed, std::vector<std::string>{"through\t6.0"});
    registry.view<Camera, Transform>().each([&](Entity, Camera& c, Transform& t) {
      EXPECT_EQ(c.vertical_fov_deg, 60.0f);
      EXPECT_EQ(t.position_m, glm::vec3(0, 1.7f, 2));
    });
  }
}

TEST_F(TimelineTest, CameraPathsTakeTheActiveCameraOrTheGivenOne) {
  expect_ok(
      "a = world.spawn{camera={active=false}} b = world.spawn{camera={}} "
      "camera.path{{time_s=0, position={1, 0, 0}}} camera.path{camera=a, {time_s=0, position={2, 0, 0}}} "
      "assert(b.transform.position_m.x == 1 and a.transform.position_m.x == 2)");
}

TEST_F(TimelineTest, CameraPathErrors) {
  EXPECT_CONTAINS(error_of("camera.path{{time_s=0, position={0,0,0}}}"), "no camera");
  const std::string spawn = "world.spawn{camera={}} ";
  EXPECT_CONTAINS(error_of(spawn + "camera.path{}"), "keys");
  EXPECT_CONTAINS(error_of(spawn + "camera.path{{position={0,0,0}}}"), "time_s");
  EXPECT_CONTAINS(error_of(spawn + "camera.path{{time_s=1, position={0,0,0}}, {time_s=1, position={1,0,0}}}"), "key 2");
  EXPECT_CONTAINS(error_of(spawn + "camera.path{{time_s=0, postion={0,0,0}}}"), "position");
  EXPECT_CONTAINS(error_of(spawn + "camera.path{{time_s=0, position={0,0/0,0}}}"), "finite");
  EXPECT_CONTAINS(error_of(spawn + "camera.path{{time_s=0, position={0,0}}}"), "position");
}

TEST_F(TimelineTest, PinnedFieldsHold) {
  ASSERT_TRUE(host().pin("emitter", "rain_mm_per_hour", 0));
  expect_ok(
      "local e = world.spawn{emitter={rain_mm_per_hour=20}} go(function() tween(e.emitter, 'rain_mm_per_hour', 50, 1) "
      "e.emitter.rain_mm_per_hour = 7 end)");
  EXPECT_EQ(emitter().rain_mm_per_hour, 0.0f);
  advance(0.5);
  EXPECT_EQ(emitter().rain_mm_per_hour, 0.0f);
  ASSERT_TRUE(host().pin("emitter", "rain_mm_per_hour", 33.0));
  EXPECT_EQ(emitter().rain_mm_per_hour, 33.0f);
  advance(2.0);
  EXPECT_EQ(emitter().rain_mm_per_hour, 33.0f);
  EXPECT_FALSE(host().pin("emitter", "rain_mm_per_hour", -1));
  EXPECT_FALSE(host().pin("emitter", "rain", 1));
  EXPECT_FALSE(host().pin("rain", "rain", 1));
  expect_ok("assert(world.spawn{emitter={}}.emitter.rain_mm_per_hour == 33)");
  made.reset();
  options.services.load_model = [&](const std::filesystem::path&) {
    const Entity entity = registry.create();
    registry.emplace<Emitter>(entity).rain_mm_per_hour = 99.0f;
    return std::vector<Entity>{entity};
  };
  ASSERT_TRUE(host().pin("emitter", "rain_mm_per_hour", 5));
  expect_ok("assert(world.model('rain.glb')[1].emitter.rain_mm_per_hour == 5)");
}

}  // namespace
}  // namespace petrichor
