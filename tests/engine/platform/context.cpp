#include "engine/platform/context.hpp"

#include <epoxy/gl.h>

#include <cstdio>
#include <cstdlib>

#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

// The environment decides which device is taken; each test puts it back.
struct Variable {
  Variable(const char* name, const char* value) : name_(name) { value ? setenv(name, value, 1) : unsetenv(name); }
  ~Variable() { unsetenv(name_); }
  const char* name_;
};

TEST(Headless, GivesACoreContextOfAtLeast45) {
  auto context = make_headless_context({.debug = true});
  ASSERT_TRUE(context) << context.error().message;
  GLint major = 0, minor = 0, profile = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  EXPECT_GE(major * 10 + minor, 45);
  EXPECT_TRUE(profile & GL_CONTEXT_CORE_PROFILE_BIT);
  EXPECT_FALSE((*context)->has_window());
  EXPECT_FALSE((*context)->device().renderer.empty());
  EXPECT_NE((*context)->device().version.find('.'), std::string::npos);
}

TEST(Headless, SoftwareIsRecognised) {
  const Variable wish("PETRICHOR_DEVICE", "software");
  auto context = make_headless_context({});
  if (!context) GTEST_SKIP() << context.error().message;  // a machine with a GPU and without Mesa
  EXPECT_TRUE((*context)->device().software) << (*context)->device().renderer;
}

TEST(Headless, TwoContextsLiveSideBySideAndOneSurvivesTheOther) {
  auto first = make_headless_context({.debug = true});
  ASSERT_TRUE(first);
  {
    auto second = make_headless_context({.debug = true});
    ASSERT_TRUE(second);
    (*second)->make_current();
    EXPECT_NE(glGetString(GL_VERSION), nullptr);
  }
  (*first)->make_current();
  GLuint texture = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  EXPECT_NE(texture, 0u);
  glDeleteTextures(1, &texture);
}

TEST(Headless, GlErrorsAreCounted) {
  auto context = make_headless_context({.debug = true});
  ASSERT_TRUE(context);
  const int before = gl_error_count();
  glEnable(0xdead);
  EXPECT_EQ(gl_error_count(), before + 1);
  EXPECT_FALSE(last_gl_error().empty());
}

TEST(Headless, AnImpossibleWishIsAMessage) {
  const Variable wish("PETRICHOR_DEVICE", "999");
  auto context = make_headless_context({});
  ASSERT_FALSE(context);
  EXPECT_NE(context.error().message.find("PETRICHOR_DEVICE=999"), std::string::npos) << context.error().message;
  EXPECT_NE(context.error().message.find("number below"), std::string::npos);
}

// Mesa can be told to offer less than it has, before it is first used: hence a process of its own. No other driver
// listens; a machine with a GPU and without Mesa has no software device, and the message then says that.
TEST(HeadlessDeathTest, TooOldAnOpenGlSaysWhatWasFoundAndWhatIsNeeded) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const Variable software("PETRICHOR_DEVICE", "software");
  const Variable old("MESA_GL_VERSION_OVERRIDE", "3.3");
  const auto attempt = [] {
    auto context = make_headless_context({});
    std::fputs(context ? "a context" : context.error().message.c_str(), stderr);
    std::_Exit(context ? 1 : 0);
  };
  EXPECT_EXIT(attempt(), ::testing::ExitedWithCode(0),
              "Found:.*(OpenGL 3.3 at most|NVIDIA).*Needed: OpenGL 4.5.*libgl1-mesa-dri");
}

TEST(Window, WithoutADisplayIsAMessage) {
  unsetenv("WAYLAND_DISPLAY");
  const char* shown = std::getenv("DISPLAY");
  const std::string display = shown ? shown : "";
  unsetenv("DISPLAY");
  EXPECT_FALSE(display_available());
  auto context = make_window_context({});
  ASSERT_FALSE(context);
  EXPECT_NE(context.error().message.find("DISPLAY"), std::string::npos);

  setenv("DISPLAY", ":4711", 1);
  EXPECT_FALSE(display_available());
  context = make_window_context({});
  ASSERT_FALSE(context);
  EXPECT_NE(context.error().message.find("4711"), std::string::npos) << context.error().message;
  shown ? setenv("DISPLAY", display.c_str(), 1) : unsetenv("DISPLAY");
}

// Runs where there is a display (xvfb-run counts).
TEST(Window, OpensAndPolls) {
  if (!display_available()) GTEST_SKIP() << "no display";
  auto context = make_window_context({.debug = true, .vsync = false, .width = 320, .height = 200});
  ASSERT_TRUE(context) << context.error().message;
  EXPECT_TRUE((*context)->has_window());
  EXPECT_NE((*context)->native_window(), nullptr);
  int width = 0, height = 0;
  (*context)->framebuffer_size(width, height);
  EXPECT_GT(width, 0);
  EXPECT_GT(height, 0);
  const int before = gl_error_count();
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  (*context)->present();
  EXPECT_FALSE((*context)->poll().close_requested);
  EXPECT_EQ(gl_error_count(), before) << last_gl_error();
}

}  // namespace
}  // namespace petrichor
