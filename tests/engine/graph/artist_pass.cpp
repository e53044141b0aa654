#include "tests/engine/graph/graph_test.hpp"

namespace petrichor {
namespace {

using nlohmann::json;
using test::rgba16f;

constexpr const char* kTint = R"(layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f) uniform writeonly image2D result;
uniform sampler2D source;
uniform vec3 tint;
uniform ivec2 u_size;
void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, u_size))) return;
  imageStore(result, at, vec4(texelFetch(source, at, 0).rgb * tint, 1.0));
}
)";

class ArtistPassTest : public test::GlTest {
 protected:
  ArtistPassTest() { data.write("tint.comp.glsl", kTint); }
  static json table(json artist) {
    return {{"resources", {{"a", rgba16f()}, {"b", rgba16f()}, {"n", {{"format", "r32ui"}}}}},
            {"passes", {{{"pass", "fill"}, {"out", "a"}, {"parameters", {{"value", 2}}}}, std::move(artist)}},
            {"output", "b"}};
  }
  static json tint() {
    return {{"compute", "tint.comp.glsl"},
            {"read", {{"source", "a"}}},
            {"write", {{"result", "b"}}},
            {"parameters", {{"tint", {3, 1, 1}}}}};
  }
  std::vector<float> run() {
    auto output = graph.execute({}, 13, 7, timer);
    if (!output) {
      ADD_FAILURE() << output.error().message;
      return {};
    }
    std::vector<float> pixels(13 * 7 * 4);
    glGetTextureImage((*output)->id, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(pixels.size() * 4), pixels.data());
    return pixels;
  }
  std::string error(const json& t) {
    auto done = graph.load_table(t, "city.lua");
    return done ? "(no error)" : done.error().message;
  }
  void expect_error(const json& artist, const char* part) {
    const std::string message = error(table(artist));
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }

  test::DataFolder data;
  test::Seen seen;
  ShaderLibrary shaders;
  Graph graph{shaders, test::offers(seen)};
  FrameTimer timer{true};
};

TEST_F(ArtistPassTest, CoversEveryPixelWithItsParameters) {
  ASSERT_EQ(error(table(tint())), "(no error)");
  const std::vector<float> pixels = run();
  for (std::size_t i = 0; i < pixels.size(); i += 4) {
    ASSERT_EQ(pixels[i], 6.0f) << i;
    ASSERT_EQ(pixels[i + 1], 2.0f) << i;
  }
  EXPECT_EQ(graph.report().at(1).name, "tint");
  EXPECT_EQ(graph.files(), std::vector<std::string>{"tint.comp.glsl"});
}

TEST_F(ArtistPassTest, PutsItselfIntoAChainUnderOneName) {
  json t = table(tint());
  t["passes"][1]["write"]["result"] = "a";
  t["output"] = "a";
  ASSERT_EQ(error(t), "(no error)");
  EXPECT_EQ(run().at(0), 6.0f);
}

TEST_F(ArtistPassTest, ModifiesInPlace) {
  data.write(
      "twice.comp.glsl",
      "layout(local_size_x = 4, local_size_y = 4) in;\nlayout(rgba16f) uniform image2D img;\n"
      "void main() { ivec2 at = ivec2(gl_GlobalInvocationID.xy); imageStore(img, at, 2.0 * imageLoad(img, at)); }\n");
  json t = table({{"compute", "twice.comp.glsl"}, {"modify", {{"img", "a"}}}});
  t["output"] = "a";
  ASSERT_EQ(error(t), "(no error)");
  EXPECT_EQ(run().back(), 4.0f);
}

TEST_F(ArtistPassTest, ReloadsWhileRunningAndABrokenEditKeepsTheLastGood) {
  ASSERT_EQ(error(table(tint())), "(no error)");
  EXPECT_EQ(run().at(0), 6.0f);
  std::string edited = kTint;
  edited.replace(edited.find("* tint"), 6, "+ tint");
  data.write("tint.comp.glsl", edited);
  EXPECT_TRUE(shaders.reload_changed().empty());
  EXPECT_EQ(run().at(0), 5.0f);
  data.write("tint.comp.glsl", "broken");
  EXPECT_EQ(shaders.reload_changed().size(), 1u);
  EXPECT_EQ(run().at(0), 5.0f);
}

TEST_F(ArtistPassTest, AShaderThatDoesNotCompileKeepsTheOldTable) {
  ASSERT_EQ(error(table(tint())), "(no error)");
  EXPECT_EQ(run().at(0), 6.0f);
  data.write("bad.comp.glsl", "layout(local_size_x = 1) in;\nvoid main() {\n  oops;\n}\n");
  json bad = tint();
  bad["compute"] = "bad.comp.glsl";
  const std::string message = error(table(bad));
  EXPECT_NE(message.find("city.lua: pass bad: "), std::string::npos) << message;
  EXPECT_NE(message.find("bad.comp.glsl:3: "), std::string::npos) << message;
  EXPECT_EQ(run().at(0), 6.0f);
  EXPECT_EQ(graph.files(), (std::vector<std::string>{"bad.comp.glsl", "tint.comp.glsl"})) << "to be watched";
  data.write("bad.comp.glsl", kTint);
  ASSERT_EQ(error(table(bad)), "(no error)");
  EXPECT_EQ(graph.files(), std::vector<std::string>{"bad.comp.glsl"});
}

TEST_F(ArtistPassTest, NamesThatCannotWorkAreErrors) {
  json wrong = tint();
  wrong["compute"] = "nowhere.comp.glsl";
  expect_error(wrong, "nowhere.comp.glsl: no such shader");
  wrong = tint();
  wrong["parameters"]["tint"] = 3;
  expect_error(wrong, "\"tint\" is given 1 number(s), which does not fit");
  wrong = tint();
  wrong["write"] = {{"tint", "b"}};
  wrong.erase("parameters");
  expect_error(wrong, "\"tint\" is in write or modify, but the shader declares it as no image");
  wrong = tint();
  wrong["read"] = {{"result", "a"}};
  wrong["write"] = {{"other", "b"}};
  expect_error(wrong, "\"result\" is in read, but the shader declares it as no 2D");
}

}  // namespace
}  // namespace petrichor
