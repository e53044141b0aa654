#include "engine/gpu/timer.hpp"

#include <chrono>
#include <thread>

#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

using Timer = test::GlTest;

TEST_F(Timer, SoftwareTimesOnlyFramesThatAreProfiled) {
  FrameTimer timer(true);
  timer.begin_frame(false);
  timer.begin("a");
  timer.end();
  timer.end_frame();
  EXPECT_TRUE(timer.collect().empty());

  timer.begin_frame(true);
  timer.begin("outer");
  timer.begin("inner");
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  timer.end();
  timer.end();
  timer.end_frame();
  const auto timings = timer.collect();
  ASSERT_EQ(timings.size(), 2u);
  EXPECT_EQ(timings[0].name, "outer");
  EXPECT_EQ(timings[1].name, "inner");
  EXPECT_GE(timings[1].milliseconds, 20.0);  // sleep_for never wakes early
  EXPECT_GE(timings[0].milliseconds, timings[1].milliseconds);
  EXPECT_TRUE(timer.collect().empty()) << "a frame is handed out once";
  EXPECT_FALSE(timer.gpu_times_are_real());
}

// The query path runs on every driver; only its figures mean nothing on software OpenGL.
TEST_F(Timer, QueriesComeBackLaterAndOnce) {
  FrameTimer timer(false);
  int frames_back = 0;
  for (int frame = 0; frame < 20; ++frame) {
    timer.begin_frame(false);
    timer.begin("pass " + std::to_string(frame));
    timer.end();
    timer.end_frame();
    glFinish();
    const auto timings = timer.collect();
    if (timings.empty()) continue;
    ++frames_back;
    ASSERT_EQ(timings.size(), 1u);
    EXPECT_EQ(timings[0].name, "pass " + std::to_string(frame)) << "the newest finished frame";
    EXPECT_GE(timings[0].milliseconds, 0.0);
  }
  EXPECT_EQ(frames_back, 20);
}

TEST_F(Timer, NobodyCollectingDoesNoHarm) {
  FrameTimer timer(false);
  for (int frame = 0; frame < 40; ++frame) {
    timer.begin_frame(false);
    timer.begin("pass");
    timer.end();
    timer.end_frame();
  }
  glFinish();
  EXPECT_EQ(timer.collect().size(), 1u);
  EXPECT_TRUE(timer.collect().empty());
  timer.begin_frame(false);
  timer.begin("again");
  timer.end();
  timer.end_frame();
  glFinish();
  EXPECT_EQ(timer.collect().at(0).name, "again");
}

}  // namespace
}  // namespace petrichor
