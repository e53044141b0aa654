#include "engine/gpu/shader.hpp"

#include <vector>

#include "engine/gpu/shader_source.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

using test::DataFolder;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class Shader : public test::GlTest {
 protected:
  std::string load_error(const std::string& file, std::vector<std::string> defines = {}) {
    auto program = library.load({{file}, std::move(defines)});
    return program ? "" : program.error().message;
  }
  // Runs a shader that writes one uint to binding 0.
  unsigned result(const Program& program) {
    Buffer out = make_buffer(4);
    clear_buffer(out);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, out.id);
    program.dispatch(1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    unsigned value = 0;
    read_buffer(out, &value, 4);
    return value;
  }
  static std::string writes(const std::string& expression, const std::string& head = "") {
    return head + "layout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer Out { uint value; };\n" +
           "void main() { value = uint(" + expression + "); }\n";
  }
  DataFolder data;
  ShaderLibrary library;
};

TEST_F(Shader, RunsWithDefinesAndUniforms) {
  data.write("a.comp.glsl", writes("u_a + u_b.y + N", "uniform int u_a; uniform vec2 u_b;\n"));
  auto program = library.load({{"a.comp.glsl"}, {"N 100"}});
  ASSERT_TRUE(program) << program.error().message;
  (*program)->set("u_a", 3);
  (*program)->set("u_b", glm::vec2(0, 20));
  (*program)->set("u_nowhere", 1.0f);
  EXPECT_EQ(result(**program), 123u);
  EXPECT_EQ(*library.load({{"a.comp.glsl"}, {"N 100"}}), *program) << "loads once";
  auto other = library.load({{"a.comp.glsl"}, {"N 7"}});
  ASSERT_TRUE(other);
  EXPECT_NE(*other, *program);
  EXPECT_EQ(result(**other), 7u);
}

TEST_F(Shader, NumbersFitWhateverTypeTheUniformHas) {
  data.write("n.comp.glsl",
             writes("f + i + int(u) + (b ? 1000 : 0) + v.z",
                    "uniform float f; uniform int i; uniform uint u; uniform bool b; uniform ivec3 v;\n"));
  const Program* program = *library.load({{"n.comp.glsl"}, {}});
  const auto set = [&](const char* name, std::vector<double> v) { return program->set_numbers(name, v); };
  EXPECT_TRUE(set("f", {1}));
  EXPECT_TRUE(set("i", {20}));
  EXPECT_TRUE(set("u", {300}));
  EXPECT_TRUE(set("b", {1}));
  EXPECT_TRUE(set("v", {0, 0, 4000}));
  EXPECT_EQ(result(*program), 5321u);
  EXPECT_FALSE(set("v", {1}));
  EXPECT_FALSE(set("nowhere", {1}));
  EXPECT_EQ(program->uniform_type("v"), GLenum(GL_INT_VEC3));
}

TEST_F(Shader, DispatchCoversAllInvocations) {
  data.write(
      "d.comp.glsl",
      "layout(local_size_x = 8, local_size_y = 4) in;\nlayout(std430, binding = 0) buffer Out { uint value; };\n"
      "void main() { if (gl_GlobalInvocationID.x < 17u && gl_GlobalInvocationID.y < 5u) atomicAdd(value, 1u); }\n");
  const Program* program = *library.load({{"d.comp.glsl"}, {}});
  EXPECT_EQ(program->group_size(), glm::ivec3(8, 4, 1));
  Buffer out = make_buffer(4);
  clear_buffer(out);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, out.id);
  program->dispatch(17, 5);
  program->dispatch(0, 5);  // nothing to do is no error
  unsigned value = 0;
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  read_buffer(out, &value, 4);
  EXPECT_EQ(value, 85u);
}

TEST_F(Shader, IncludesComeInOnceFromRootOrBeside) {
  data.write("lib/one.glsl", "#pragma once\nuint one() { return 1u; }\n");
  data.write("lib/two.glsl",
             "#include \"lib/one.glsl\"\n#include \"beside.glsl\"\nuint two() { return one() + one(); }");
  data.write("lib/beside.glsl", "uint four() { return 4u; }\n");
  data.write("m.comp.glsl",
             "#include \"lib/one.glsl\"\n#include \"lib/two.glsl\"\n" + writes("one() + two() + four()"));
  auto program = library.load({{"m.comp.glsl"}, {}});
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ(result(**program), 7u);
}

TEST_F(Shader, AnIncludeUnderAFalseConditionIsThereForALaterOne) {
  data.write("one.glsl", "uint one() { return 1u; }\n");
  data.write("m.comp.glsl",
             "#ifdef NOT_DEFINED\n#include \"one.glsl\"\n#endif\n#include \"one.glsl\"\n#if 1\n#include \"one.glsl\"\n"
             "#endif\n" +
                 writes("one()"));
  auto program = library.load({{"m.comp.glsl"}, {}});
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ(result(**program), 1u);
}

TEST_F(Shader, HeadersSharedWithCppLeaveTheirCppOut) {
  data.write(
      "shared.h",
      "#pragma once\n#ifdef __cplusplus\n#include <glm/glm.hpp>\n#include \"no/such/file.hpp\"\nusing glm::vec4;\n"
      "#if 1\nnamespace x {\n#endif\n#else\n#define GLSL_SIDE 5\n#endif\n#ifndef __cplusplus\n#define MORE "
      "6\n#endif\n");
  data.write("m.comp.glsl", "#include \"shared.h\"\n" + writes("GLSL_SIDE + MORE"));
  auto program = library.load({{"m.comp.glsl"}, {}});
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ(result(**program), 11u);
}

TEST_F(Shader, ACommentedIncludeIsNone) {
  data.write("m.comp.glsl", "// #include \"nowhere\"\n/* \n#include \"nowhere\"\n*/\n" + writes("1"));
  EXPECT_EQ(load_error("m.comp.glsl"), "");
}

TEST_F(Shader, VersionOfTheFileStaysFirstAndDefinesFollow) {
  data.write("m.comp.glsl", "// licence\n#version 430 core\n" + writes("__VERSION__ + N"));
  auto program = library.load({{"m.comp.glsl"}, {"N"}});
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ(result(**program), 431u);
}

TEST_F(Shader, ErrorsNameFileAndLine) {
  data.write("m.comp.glsl", "layout(local_size_x = 1) in;\n\nvoid main() {\n  nonsense;\n}\n");
  EXPECT_TRUE(has(load_error("m.comp.glsl", {"A", "B 2"}), "m.comp.glsl:4: ")) << load_error("m.comp.glsl");
  data.write("v.comp.glsl", "#version 450 core\nlayout(local_size_x = 1) in;\n\nvoid main() {\n  nonsense;\n}\n");
  EXPECT_TRUE(has(load_error("v.comp.glsl", {"A"}), "v.comp.glsl:5: ")) << load_error("v.comp.glsl");
}

TEST_F(Shader, ErrorsInAndAfterIncludesNameFileAndLine) {
  data.write("lib/good.glsl", "float g() { return 1.0; }\n\n\n");
  data.write("lib/bad.glsl", "// one\n// two\nfloat b() { return missing_1; }\n");
  data.write("m.comp.glsl",
             "layout(local_size_x = 1) in;\n#include \"lib/good.glsl\"\n#include \"lib/bad.glsl\"\nvoid main() {}\n");
  EXPECT_TRUE(has(load_error("m.comp.glsl"), "lib/bad.glsl:3: ")) << load_error("m.comp.glsl");
  data.write("n.comp.glsl",
             "layout(local_size_x = 1) in;\n#include \"lib/good.glsl\"\n#if 1\n#include \"lib/good.glsl\"\n#endif\n"
             "void main() {\n  missing_2;\n}\n");
  EXPECT_TRUE(has(load_error("n.comp.glsl"), "n.comp.glsl:7: ")) << load_error("n.comp.glsl");
}

TEST_F(Shader, MissingIncludesCirclesAndStrangeNamesAreErrors) {
  data.write("m.comp.glsl", "\n#include \"lib/nowhere.glsl\"\n");
  EXPECT_TRUE(has(load_error("m.comp.glsl"), "m.comp.glsl:2: cannot find \"lib/nowhere.glsl\""))
      << load_error("m.comp.glsl");
  data.write("a.glsl", "#include \"b.glsl\"\n");
  data.write("b.glsl", "\n#include \"a.glsl\"\n");
  data.write("c.comp.glsl", "#include \"a.glsl\"\n");
  EXPECT_TRUE(has(load_error("c.comp.glsl"), "b.glsl:2: #include goes round in a circle: a.glsl -> b.glsl -> a.glsl"))
      << load_error("c.comp.glsl");
  data.write("q.comp.glsl", "#include nonsense\n");
  EXPECT_TRUE(has(load_error("q.comp.glsl"), "q.comp.glsl:1: "));
  data.write("lib/v.glsl", "#version 450\n");
  data.write("w.comp.glsl", "#include \"lib/v.glsl\"\n");
  EXPECT_TRUE(has(load_error("w.comp.glsl"), "lib/v.glsl:1: #version"));
  EXPECT_TRUE(has(load_error("nowhere.comp.glsl"), "nowhere.comp.glsl: no such shader"));
  data.write("x.glsl", "");
  EXPECT_TRUE(has(load_error("x.glsl"), ".comp.glsl"));
}

TEST_F(Shader, LinkErrorsAreErrors) {
  data.write("p.vert.glsl", "out vec3 colour;\nvoid main() { colour = vec3(1); gl_Position = vec4(0); }\n");
  data.write("p.frag.glsl", "in vec2 colour;\nout vec4 c;\nvoid main() { c = colour.xyxy; }\n");
  auto program = library.load({{"p.vert.glsl", "p.frag.glsl"}, {}});
  ASSERT_FALSE(program);
  EXPECT_TRUE(has(program.error().message, "p.vert.glsl + p.frag.glsl does not link")) << program.error().message;
  data.write("p.frag.glsl", "in vec3 colour;\nout vec4 c;\nvoid main() { c = colour.xyzx; }\n");
  program = library.load({{"p.vert.glsl", "p.frag.glsl"}, {}});
  EXPECT_TRUE(program);
}

TEST_F(Shader, ReloadFollowsTheFileAndItsIncludes) {
  data.write("lib/n.glsl", "#define N 1\n");
  data.write("m.comp.glsl", "#include \"lib/n.glsl\"\n" + writes("N"));
  const Program* program = *library.load({{"m.comp.glsl"}, {}});
  bool changed = true;
  EXPECT_TRUE(library.reload_changed(&changed).empty());
  EXPECT_FALSE(changed);
  data.write("lib/n.glsl", "#define N 2\n");
  EXPECT_TRUE(library.reload_changed(&changed).empty());
  EXPECT_TRUE(changed);
  EXPECT_EQ(result(*program), 2u) << "the same pointer runs the new code";
}

TEST_F(Shader, AFailingReloadKeepsTheLastGoodProgram) {
  data.write("m.comp.glsl", writes("u_a", "uniform int u_a;\n"));
  const Program* program = *library.load({{"m.comp.glsl"}, {}});
  program->set("u_a", 5);
  data.write("m.comp.glsl", "layout(local_size_x = 1) in;\nvoid main() {\n  broken;\n}\n");
  bool changed = true;
  auto failures = library.reload_changed(&changed);
  ASSERT_EQ(failures.size(), 1u);
  EXPECT_TRUE(has(failures[0], "m.comp.glsl:3: ")) << failures[0];
  EXPECT_FALSE(changed);
  EXPECT_EQ(result(*program), 5u);
  EXPECT_TRUE(library.reload_changed().empty()) << "said once, not every time";

  data.write("m.comp.glsl", "#include \"late.glsl\"\n" + writes("LATE"));
  EXPECT_EQ(library.reload_changed().size(), 1u);
  data.write("late.glsl", "#define LATE 9\n");  // the missing include turns up
  EXPECT_TRUE(library.reload_changed(&changed).empty());
  EXPECT_TRUE(changed);
  EXPECT_EQ(result(*program), 9u);

  std::filesystem::remove(data.path() / "late.glsl");  // an editor between delete and rename
  EXPECT_TRUE(library.reload_changed(&changed).empty());
  EXPECT_EQ(result(*program), 9u);
}

// The three dialects, whatever driver the test runs on.
TEST(ShaderLog, KnowsTheDialectsOfDrivers) {
  const std::vector<SourceFile> files{{"main.comp.glsl", {}}, {"lib/b.glsl", {}}};
  EXPECT_EQ(map_shader_log("1:12(5): error: `x' undeclared\n", files), "lib/b.glsl:12: error: `x' undeclared");
  EXPECT_EQ(map_shader_log("0(7) : error C1503: undefined variable \"x\"\n", files),
            "main.comp.glsl:7: error C1503: undefined variable \"x\"");
  EXPECT_EQ(map_shader_log("ERROR: 1:3: 'x' : undeclared\nWARNING: 0:4: odd", files),
            "lib/b.glsl:3: error: 'x' : undeclared\nmain.comp.glsl:4: warning: odd");
  EXPECT_EQ(map_shader_log("77:3(1): error: z\nplain text", files), "77:3(1): error: z\nplain text");
  EXPECT_EQ(map_shader_log("", files), "");
}

}  // namespace
}  // namespace petrichor
