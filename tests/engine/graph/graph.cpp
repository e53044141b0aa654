#include "engine/graph/graph.hpp"

#include <algorithm>
#include <set>

#include "tests/engine/graph/graph_test.hpp"

namespace petrichor {
namespace {

using nlohmann::json;
using test::first_pixel;
using test::rgba16f;
using Order = std::vector<std::string>;

class GraphTest : public test::GlTest {
 protected:
  void load(const json& table) {
    auto done = graph.load_table(table, "city.lua");
    ASSERT_TRUE(done) << done.error().message;
  }
  // The first pixel of the output; fails the test where there is none.
  float run(const Frame& frame = {}, int width = 8, int height = 4) {
    seen = {};
    timer.begin_frame(false);
    auto output = graph.execute(frame, width, height, timer);
    timer.end_frame();
    if (!output) {
      ADD_FAILURE() << output.error().message;
      return -1;
    }
    return first_pixel(**output);
  }
  PassReport report(const std::string& name) {
    for (const PassReport& r : graph.report()) {
      if (r.name == name) return r;
    }
    ADD_FAILURE() << "no pass " << name;
    return {};
  }

  test::Seen seen;
  ShaderLibrary shaders;
  Graph graph{shaders, test::offers(seen)};
  FrameTimer timer{true};
};

json pass(const char* name, json slots) {
  slots["pass"] = name;
  return slots;
}

TEST_F(GraphTest, RunsInTheOrderOfTheTable) {
  load({{"resources", {{"a", rgba16f()}, {"b", rgba16f()}}},
        {"passes",
         {pass("fill", {{"out", "a"}, {"parameters", {{"value", 2}}}}), pass("add", {{"target", "a"}}),
          pass("copy", {{"image", "a"}, {"out", "b"}})}},
        {"output", "b"}});
  EXPECT_EQ(run(), 12.0f);
  EXPECT_EQ(seen.order, (Order{"fill", "add", "copy"}));
  EXPECT_FALSE(report("add").culled);
}

TEST_F(GraphTest, CullsWhatNobodyReadsAndWhatOnlyThatNeeds) {
  load({{"resources", {{"a", rgba16f()}, {"b", rgba16f()}, {"c", rgba16f()}}},
        {"passes",
         {pass("fill", {{"out", "a"}}), pass("fill", {{"out", "b"}, {"id", "other"}}),
          pass("copy", {{"image", "b"}, {"out", "c"}})}},
        {"output", "a"}});
  run();
  EXPECT_EQ(seen.order, Order{"fill"});
  EXPECT_TRUE(report("copy").culled);
  EXPECT_EQ(report("copy").reason, "nobody reads c");
  EXPECT_EQ(report("other").reason, "nobody reads b");
}

TEST_F(GraphTest, AWriteMakesWhatWasThereBeforeUnread) {
  load({{"resources", {{"a", rgba16f()}}},
        {"passes",
         {pass("fill", {{"out", "a"}}), pass("add", {{"target", "a"}}),
          pass("fill", {{"out", "a"}, {"id", "again"}, {"parameters", {{"value", 4}}}})}},
        {"output", "a"}});
  EXPECT_EQ(run(), 4.0f);
  EXPECT_TRUE(report("fill").culled);
  EXPECT_TRUE(report("add").culled);
}

// The dry frame of the design: no rain pass runs, and the rest draws as if it were not in the table.
TEST_F(GraphTest, AnUnwantedModifyPassesTheResourceOn) {
  load({{"resources", {{"a", rgba16f()}}},
        {"passes", {pass("fill", {{"out", "a"}}), pass("rain", {{"target", "a"}}), pass("add", {{"target", "a"}})}},
        {"output", "a"}});
  EXPECT_EQ(run(), 111.0f);
  EXPECT_EQ(run({.rain = false}), 11.0f);
  EXPECT_EQ(seen.order, (Order{"fill", "add"}));
  EXPECT_TRUE(report("rain").culled);
  EXPECT_EQ(report("rain").reason, "no component asks for it");
  EXPECT_EQ(run(), 111.0f) << "and comes back";
}

TEST_F(GraphTest, AnOptionalReadOfAnUnwantedWriterIsEmpty) {
  load({{"resources", {{"a", rgba16f()}, {"m", rgba16f()}, {"o", rgba16f()}}},
        {"passes",
         {pass("fill", {{"out", "a"}}), pass("fog", {{"mask", "m"}}),
          pass("mix", {{"image", "a"}, {"mask", "m"}, {"out", "o"}})}},
        {"output", "o"}});
  EXPECT_EQ(run(), 1001.0f);
  EXPECT_TRUE(seen.flags[0]);
  EXPECT_EQ(run({.fog = false}), 1.0f);
  EXPECT_FALSE(seen.flags[0]);
}

TEST_F(GraphTest, ARequiredReadOfAnUnwantedWriterCullsTheReaderToo) {
  load({{"resources", {{"a", rgba16f()}, {"m", rgba16f()}}},
        {"passes", {pass("fill", {{"out", "a"}}), pass("fog", {{"mask", "m"}}), pass("measure", {{"image", "m"}})}},
        {"output", "a"}});
  run();
  EXPECT_EQ(seen.order, (Order{"fill", "fog", "measure"}));
  run({.fog = false});
  EXPECT_EQ(seen.order, Order{"fill"});
  EXPECT_EQ(report("measure").reason, "m has no content: fog does not run (no component asks for it)");
}

TEST_F(GraphTest, AnOutputWithoutContentIsAnError) {
  load({{"resources", {{"m", rgba16f()}}}, {"passes", {pass("fog", {{"mask", "m"}})}}, {"output", "m"}});
  auto output = graph.execute({.fog = false}, 8, 4, timer);
  ASSERT_FALSE(output);
  EXPECT_EQ(output.error().message, "the output \"m\" has no content: fog does not run (no component asks for it)");
  EXPECT_EQ(run(), 1000.0f);
}

TEST_F(GraphTest, ClearedResourcesHaveContentWithoutAWriter) {
  load({{"resources", {{"m", rgba16f({{"clear", {3, 0, 0, 1}}})}, {"o", rgba16f()}}},
        {"passes", {pass("fog", {{"mask", "m"}}), pass("copy", {{"image", "m"}, {"out", "o"}})}},
        {"output", "o"}});
  EXPECT_EQ(run(), 1000.0f);
  EXPECT_EQ(run({.fog = false}), 3.0f);
  // As the output itself, too.
  load({{"resources", {{"m", rgba16f({{"clear", 6}})}}}, {"passes", {pass("fog", {{"mask", "m"}})}}, {"output", "m"}});
  EXPECT_EQ(run({.fog = false}), 6.0f);
  // And a modify starts from it, every frame anew.
  load(
      {{"resources", {{"a", rgba16f({{"clear", 2}})}}}, {"passes", {pass("add", {{"target", "a"}})}}, {"output", "a"}});
  EXPECT_EQ(run(), 12.0f);
  EXPECT_EQ(run(), 12.0f);
}

// Passes that meet in a buffer of their own say so with a resource without a texture.
TEST_F(GraphTest, ResourcesWithoutATextureOrderAndCull) {
  using enum SlotAccess;
  std::vector<std::string> order;
  std::vector<PassOffer> offers;
  offers.push_back({.name = "cells",
                    .slots = {{"cells", write}},
                    .wanted = [](const Frame& f) { return f.rain; },
                    .execute =
                        [&](PassContext& p) {
                          order.push_back("cells");
                          EXPECT_TRUE(p.has("cells"));
                          EXPECT_EQ(GLuint(p.texture("cells").id), 0u);
                        }});
  offers.push_back({.name = "splat", .slots = {{"cells", read}, {"drops", write}}, .execute = [&](PassContext&) {
                      order.push_back("splat");
                    }});
  offers.push_back({.name = "composite", .slots = {{"drops", read}, {"colour", modify}}, .execute = [&](PassContext&) {
                      order.push_back("composite");
                    }});
  offers.push_back({.name = "light", .slots = {{"colour", write}}, .execute = [&](PassContext& p) {
                      order.push_back("light");
                      test::fill(p.texture("colour"), 1);
                    }});
  Graph other(shaders, std::move(offers));
  json table = {
      {"resources", {{"cells", {{"format", "none"}}}, {"drops", {{"format", "none"}}}, {"colour", rgba16f()}}},
      {"passes",
       {pass("light", {{"colour", "colour"}}), pass("cells", {{"cells", "cells"}}),
        pass("splat", {{"cells", "cells"}, {"drops", "drops"}}),
        pass("composite", {{"drops", "drops"}, {"colour", "colour"}})}},
      {"output", "colour"}};
  ASSERT_TRUE(other.load_table(table, "x"));
  ASSERT_TRUE(other.execute({}, 8, 4, timer));
  EXPECT_EQ(order, (Order{"light", "cells", "splat", "composite"}));
  order.clear();
  ASSERT_TRUE(other.execute({.rain = false}, 8, 4, timer));
  EXPECT_EQ(order, Order{"light"});
  table["passes"][3]["enabled"] = false;  // nobody lays the drops over the picture
  ASSERT_TRUE(other.load_table(table, "x"));
  order.clear();
  ASSERT_TRUE(other.execute({}, 8, 4, timer));
  EXPECT_EQ(order, Order{"light"});
}

TEST_F(GraphTest, APassMayReadAndWriteOneName) {
  load({{"resources", {{"a", rgba16f()}}},
        {"passes",
         {pass("fill", {{"out", "a"}}), pass("copy", {{"image", "a"}, {"out", "a"}}),
          pass("copy", {{"image", "a"}, {"out", "a"}, {"id", "copy_2"}})}},
        {"output", "a"}});
  EXPECT_EQ(run(), 1.0f);
  ASSERT_EQ(seen.ids.size(), 3u);
  EXPECT_NE(seen.ids[0], seen.ids[1]);
  EXPECT_NE(seen.ids[1], seen.ids[2]);
  EXPECT_EQ(seen.ids[0], seen.ids[2]) << "the first version is done with by then";
}

TEST_F(GraphTest, DisjointLifetimesShareATexture) {
  json resources, passes;
  const int n = 8;
  for (int i = 0; i < n; ++i) {
    resources["r" + std::to_string(i)] = rgba16f();
    if (i == 0) {
      passes.push_back(pass("fill", {{"out", "r0"}}));
    } else {
      passes.push_back(pass("copy", {{"image", "r" + std::to_string(i - 1)},
                                     {"out", "r" + std::to_string(i)},
                                     {"id", "copy" + std::to_string(i)}}));
    }
  }
  load({{"resources", resources}, {"passes", passes}, {"output", "r7"}});
  EXPECT_EQ(run(), 1.0f);
  EXPECT_EQ(std::set<GLuint>(seen.ids.begin(), seen.ids.end()).size(), 2u) << "a chain needs two";
  // A reader at the end keeps the first one alive: three.
  passes.push_back(pass("mix", {{"image", "r7"}, {"mask", "r0"}, {"out", "o"}}));
  resources["o"] = rgba16f();
  load({{"resources", resources}, {"passes", passes}, {"output", "o"}});
  EXPECT_EQ(run(), 2.0f);
  EXPECT_EQ(std::set<GLuint>(seen.ids.begin(), seen.ids.end()).size(), 3u);
}

TEST_F(GraphTest, DifferentSizesOrFormatsDoNotShare) {
  load({{"resources",
         {{"a", rgba16f()}, {"b", rgba16f({{"scale", 0.5}})}, {"c", {{"format", "rgba32f"}}}, {"o", rgba16f()}}},
        {"passes",
         {pass("fill", {{"out", "a"}}), pass("copy", {{"image", "a"}, {"out", "b"}}),
          pass("copy", {{"image", "b"}, {"out", "c"}, {"id", "2"}}),
          pass("copy", {{"image", "c"}, {"out", "o"}, {"id", "3"}})}},
        {"output", "o"}});
  run();
  EXPECT_EQ(std::set<GLuint>(seen.ids.begin(), seen.ids.end()).size(), 3u) << "o may take a's";
}

TEST_F(GraphTest, OptionalOutputsNobodyReadsAreLeftOut) {
  json table = {
      {"resources", {{"a", rgba16f()}, {"o", rgba16f()}, {"dbg", rgba16f()}}},
      {"passes", {pass("fill", {{"out", "a"}}), pass("mix", {{"image", "a"}, {"out", "o"}, {"debug", "dbg"}})}},
      {"output", "o"}};
  load(table);
  run();
  EXPECT_FALSE(seen.flags[1]);
  table["output"] = "dbg";
  load(table);
  EXPECT_EQ(run(), 5.0f);
  EXPECT_TRUE(seen.flags[1]);
}

TEST_F(GraphTest, HistoryIsLastFramesContent) {
  load({{"resources", {{"h", rgba16f({{"history", true}})}, {"o", rgba16f()}}},
        {"passes", {pass("copy", {{"image", "previous:h"}, {"out", "h"}}), pass("add", {{"target", "h"}})}},
        {"output", "h"}});
  EXPECT_EQ(run(), 10.0f) << "cleared on the first frame";
  EXPECT_EQ(run(), 20.0f);
  EXPECT_EQ(run(), 30.0f);
  graph.reset();
  EXPECT_EQ(run(), 10.0f);
  EXPECT_EQ(run({}, 16, 4), 10.0f) << "a new size starts anew";
  EXPECT_EQ(run({}, 16, 4), 20.0f);
}

TEST_F(GraphTest, HistoryOfAWriterThatRestedIsCleared) {
  load({{"resources", {{"h", rgba16f({{"history", true}})}, {"a", rgba16f()}, {"o", rgba16f()}}},
        {"passes",
         {pass("fill", {{"out", "a"}}), pass("mix", {{"image", "a"}, {"mask", "previous:h"}, {"out", "o"}}),
          pass("fog", {{"mask", "h"}})}},
        {"output", "o"}});
  EXPECT_EQ(run(), 1.0f);
  EXPECT_EQ(run(), 1001.0f) << "last frame's fog, though fog runs after its reader";
  EXPECT_EQ(run({.fog = false}), 1001.0f);
  EXPECT_EQ(run({.fog = false}), 1.0f);
  EXPECT_EQ(run(), 1.0f);
  EXPECT_EQ(run(), 1001.0f);
}

TEST_F(GraphTest, PersistentResourcesKeepTheirContent) {
  const json table = {
      {"resources",
       {{"map", {{"format", "r32f"}, {"persistent", true}, {"width", 16}, {"height", 16}}}, {"o", rgba16f()}}},
      {"passes", {pass("cached", {{"map", "map"}}), pass("copy", {{"image", "map"}, {"out", "o"}})}},
      {"output", "o"}};
  load(table);
  EXPECT_EQ(run(), 77.0f);
  EXPECT_EQ(seen.order.at(0), "cached anew");
  EXPECT_EQ(run(), 77.0f);
  EXPECT_EQ(seen.order.at(0), "cached kept");
  EXPECT_EQ(run({}, 20, 10), 77.0f);
  EXPECT_EQ(seen.order.at(0), "cached kept") << "a fixed size does not follow the window";
  graph.reset();
  run();
  EXPECT_EQ(seen.order.at(0), "cached anew");
  load(table);
  run();
  EXPECT_EQ(seen.order.at(0), "cached anew");
}

TEST_F(GraphTest, APersistentResourceThatFollowsTheWindowIsFreshAtANewSize) {
  load({{"resources", {{"map", {{"format", "r32f"}, {"persistent", true}}}}},
        {"passes", {pass("cached", {{"map", "map"}})}},
        {"output", "map"}});
  run();
  run();
  EXPECT_EQ(seen.order.at(0), "cached kept");
  EXPECT_EQ(run({}, 16, 8), 77.0f);
  EXPECT_EQ(seen.order.at(0), "cached anew");
}

TEST_F(GraphTest, PersistentResourcesAccumulate) {
  load({{"resources", {{"sum", rgba16f({{"persistent", true}, {"clear", 0}})}}},
        {"passes", {pass("add", {{"target", "sum"}})}},
        {"output", "sum"}});
  EXPECT_EQ(run(), 10.0f);
  EXPECT_EQ(run(), 20.0f);
  EXPECT_EQ(run(), 30.0f);
}

TEST_F(GraphTest, TheLinearOutputIsKeptWholeBesideTheOutput) {
  json table = {
      {"resources", {{"light", rgba16f()}, {"b", rgba16f()}, {"c", rgba16f()}, {"picture", rgba16f()}}},
      {"passes",
       {pass("fill", {{"out", "light"}, {"parameters", {{"value", 3}}}}),
        pass("copy", {{"image", "light"}, {"out", "b"}}), pass("add", {{"target", "b"}}),
        pass("copy", {{"image", "b"}, {"out", "c"}, {"id", "c"}}), pass("add", {{"target", "c"}, {"id", "add_c"}}),
        pass("copy", {{"image", "c"}, {"out", "picture"}, {"id", "picture"}})}},
      {"output", "picture"}};
  load(table);
  EXPECT_EQ(run(), 23.0f);
  EXPECT_EQ(graph.linear_output(), nullptr);
  table["linear_output"] = "light";
  load(table);
  EXPECT_EQ(graph.linear_output(), nullptr) << "before the first frame";
  EXPECT_EQ(run(), 23.0f);
  ASSERT_NE(graph.linear_output(), nullptr);
  EXPECT_EQ(first_pixel(*graph.linear_output()), 3.0f) << "no later pass took its texture";
  // It alone makes its writer run; without a writer this frame there is none, and the picture stands.
  load({{"resources", {{"a", rgba16f()}, {"m", rgba16f()}}},
        {"passes", {pass("fill", {{"out", "a"}}), pass("fog", {{"mask", "m"}})}},
        {"output", "a"},
        {"linear_output", "m"}});
  EXPECT_EQ(run(), 1.0f);
  EXPECT_EQ(first_pixel(*graph.linear_output()), 1000.0f);
  EXPECT_EQ(run({.fog = false}), 1.0f);
  EXPECT_EQ(graph.linear_output(), nullptr);
}

TEST_F(GraphTest, SizesFollowTheOutput) {
  load({{"resources", {{"a", rgba16f({{"scale", 0.5}, {"mips", 0}})}}},
        {"passes", {pass("fill", {{"out", "a"}})}},
        {"output", "a"}});
  for (const auto& [w, h, half_w, half_h, levels] : {std::array{9, 4, 5, 2, 3}, std::array{1, 1, 1, 1, 1}}) {
    auto output = graph.execute({}, w, h, timer);
    ASSERT_TRUE(output);
    EXPECT_EQ((*output)->width, half_w);
    EXPECT_EQ((*output)->height, half_h);
    EXPECT_EQ((*output)->levels, levels);
  }
  EXPECT_FALSE(graph.execute({}, 0, 4, timer));
}

TEST_F(GraphTest, PassesSwitchedOffAreAsIfAbsent) {
  load({{"resources", {{"a", rgba16f()}}},
        {"passes", {pass("fill", {{"out", "a"}}), pass("add", {{"target", "a"}, {"enabled", false}})}},
        {"output", "a"}});
  EXPECT_EQ(run(), 1.0f);
  EXPECT_EQ(report("add").reason, "switched off in the script");
}

TEST_F(GraphTest, ABrokenTableKeepsTheOldFrame) {
  EXPECT_FALSE(graph.execute({}, 8, 4, timer)) << "nothing loaded yet";
  load({{"resources", {{"sum", rgba16f({{"persistent", true}, {"clear", 0}})}}},
        {"passes", {pass("add", {{"target", "sum"}})}},
        {"output", "sum"}});
  run();
  auto done = graph.load_table({{"resources", json::object()}, {"passes", {{{"pass", "nothing"}}}}, {"output", "x"}},
                               "city.lua");
  ASSERT_FALSE(done);
  EXPECT_EQ(run(), 20.0f) << "and what it had accumulated";
}

TEST_F(GraphTest, TimesEveryPassThatRuns) {
  load({{"resources", {{"a", rgba16f()}}},
        {"passes", {pass("fill", {{"out", "a"}}), pass("rain", {{"target", "a"}, {"id", "shower"}})}},
        {"output", "a"}});
  timer.begin_frame(true);
  ASSERT_TRUE(graph.execute({}, 8, 4, timer));
  timer.end_frame();
  auto timings = timer.collect();
  ASSERT_EQ(timings.size(), 2u);
  EXPECT_EQ(timings[1].name, "shower");
  timer.begin_frame(true);
  ASSERT_TRUE(graph.execute({.rain = false}, 8, 4, timer));
  timer.end_frame();
  EXPECT_EQ(timer.collect().size(), 1u);
}

TEST_F(GraphTest, DotShowsCulledPassesDimmedWithTheReason) {
  load({{"resources", {{"a", rgba16f()}, {"b", rgba16f()}, {"h", rgba16f({{"history", true}})}}},
        {"passes",
         {pass("fill", {{"out", "a"}}), pass("rain", {{"target", "a"}}), pass("copy", {{"image", "a"}, {"out", "b"}}),
          pass("mix", {{"image", "a"}, {"mask", "previous:h"}, {"out", "h"}})}},
        {"output", "h"}});
  run({.rain = false});
  const std::string dot = graph.dot();
  const auto line = [&](const std::string& start) {
    const auto at = dot.find(start);
    return at == dot.npos ? "(no line)" : dot.substr(at, dot.find('\n', at) - at);
  };
  EXPECT_NE(line("\"pass rain\" [").find("dashed"), std::string::npos) << dot;
  EXPECT_NE(line("\"pass rain\" [").find("no component asks for it"), std::string::npos);
  EXPECT_NE(line("\"pass copy\" [").find("nobody reads b"), std::string::npos);
  EXPECT_EQ(line("\"pass fill\" [").find("dashed"), std::string::npos);
  EXPECT_NE(line("\"resource b\" [").find("dashed"), std::string::npos);
  EXPECT_NE(line("\"resource h\" -> \"pass mix\"").find("dashed"), std::string::npos) << "last frame's";
  EXPECT_EQ(line("\"resource a\" -> \"pass mix\"").find("dashed"), std::string::npos);
  EXPECT_EQ(dot.substr(0, 15), "digraph frame {");
}

TEST_F(GraphTest, PassesStartFromTheSameState) {
  std::vector<PassOffer> offers;
  GLboolean depth_test = GL_TRUE, blend = GL_TRUE;
  GLint viewport[4] = {};
  offers.push_back({.name = "messy", .slots = {{"out", SlotAccess::write}}, .execute = [](PassContext& p) {
                      test::fill(p.texture("out"), 1);
                      glEnable(GL_DEPTH_TEST);
                      glEnable(GL_BLEND);
                      glViewport(0, 0, 1, 1);
                    }});
  offers.push_back({.name = "next", .slots = {{"out", SlotAccess::modify}}, .execute = [&](PassContext&) {
                      depth_test = glIsEnabled(GL_DEPTH_TEST);
                      blend = glIsEnabled(GL_BLEND);
                      glGetIntegerv(GL_VIEWPORT, viewport);
                    }});
  Graph other(shaders, std::move(offers));
  ASSERT_TRUE(other.load_table({{"resources", {{"a", rgba16f()}}},
                                {"passes", {{{"1", "messy"}, {"out", "a"}}, {{"1", "next"}, {"out", "a"}}}},
                                {"output", "a"}},
                               "x"));
  ASSERT_TRUE(other.execute({}, 8, 4, timer));
  EXPECT_FALSE(depth_test);
  EXPECT_FALSE(blend);
  EXPECT_EQ(viewport[2], 8);
}

TEST_F(GraphTest, GlErrorsNameThePass) {
  std::vector<PassOffer> offers;
  offers.push_back({.name = "faulty", .slots = {}, .execute = [](PassContext&) { glEnable(0xbad); }});
  offers.push_back({.name = "fine", .slots = {{"out", SlotAccess::write}}, .execute = [](PassContext& p) {
                      test::fill(p.texture("out"), 1);
                    }});
  Graph other(shaders, std::move(offers));
  ASSERT_TRUE(other.load_table({{"resources", {{"a", rgba16f()}}},
                                {"passes", {{{"1", "faulty"}}, {{"1", "fine"}, {"out", "a"}}}},
                                {"output", "a"}},
                               "x"));
  const int before = gl_error_count();
  ASSERT_TRUE(other.execute({}, 8, 4, timer));
  EXPECT_EQ(gl_error_count(), before + 1);
  EXPECT_NE(last_gl_error().find("(in faulty)"), std::string::npos) << last_gl_error();
  expected_errors(1);
}

TEST_F(GraphTest, FramebuffersOfSlotsAreBoundAndSized) {
  std::vector<PassOffer> offers;
  using enum SlotAccess;
  int runs = 0;
  offers.push_back({.name = "raster",
                    .slots = {{"colour", write}, {"normal", write, true}, {"depth", write}},
                    .execute = [&](PassContext& p) {
                      ++runs;
                      const std::string_view colours[] = {"colour"};
                      p.bind_framebuffer(colours, "depth");
                      EXPECT_EQ(glCheckFramebufferStatus(GL_FRAMEBUFFER), GLenum(GL_FRAMEBUFFER_COMPLETE));
                      GLint viewport[4];
                      glGetIntegerv(GL_VIEWPORT, viewport);
                      EXPECT_EQ(viewport[2], (p.width + 1) / 2);
                      glClearColor(0.5f, 0, 0, 1);
                      glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
                    }});
  Graph other(shaders, std::move(offers));
  ASSERT_TRUE(other.load_table(
      {{"resources", {{"c", rgba16f({{"scale", 0.5}})}, {"z", {{"format", "depth32f"}, {"scale", 0.5}}}}},
       {"passes", {{{"1", "raster"}, {"colour", "c"}, {"depth", "z"}}}},
       {"output", "c"}},
      "x"));
  for (int size : {8, 8, 9, 8}) {
    auto output = other.execute({}, size, size, timer);
    ASSERT_TRUE(output);
    EXPECT_EQ(first_pixel(**output), 0.5f);
  }
  EXPECT_EQ(runs, 4);
}

}  // namespace
}  // namespace petrichor
