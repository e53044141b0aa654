#include "systems/interface/inspector.hpp"

#include <gtest/gtest.h>
#include <imgui.h>

#include "components/components.hpp"
#include "systems/interface/interface.hpp"

namespace petrichor {
namespace {

// Dear ImGui without a window: frames are laid out and thrown away.
struct Inspecting : testing::Test {
  void SetUp() override {
    ImGui::CreateContext();
    ImGui::GetIO().DisplaySize = ImVec2(1280, 2400);
    ImGui::GetIO().IniFilename = nullptr;
    unsigned char* pixels;
    int width, height;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  }
  void TearDown() override { ImGui::DestroyContext(); }

  template <class Fn>
  void frame(Fn&& fn) {
    ImGui::GetIO().DeltaTime = 1.0f / 60.0f;
    ImGui::NewFrame();
    fn();
    ImGui::Render();
  }

  Registry registry;
};

TEST_F(Inspecting, EveryFieldOfEveryComponentHasAWidget) {
  const Entity entity = registry.create();
  int fields = 0;
  for (const Schema& schema : component_schemas()) {
    schema.emplace(registry, entity);
    fields += static_cast<int>(schema.fields.size());
  }
  InspectorState state;
  state.selected = entity;
  int widgets = 0;
  for (int i = 0; i < 3; ++i) frame([&] { widgets = draw_inspector(registry, component_schemas(), state); });
  EXPECT_EQ(widgets, fields);
}

TEST_F(Inspecting, LookingChangesNothing) {
  const Entity entity = registry.create();
  registry.emplace<Emitter>(entity).rain_mm_per_hour = 12.5f;
  registry.emplace<Transform>(entity).position_m = {1, 2, 3};
  InspectorState state;
  state.selected = entity;
  for (int i = 0; i < 3; ++i) frame([&] { draw_inspector(registry, component_schemas(), state); });
  EXPECT_EQ(registry.get<Emitter>(entity).rain_mm_per_hour, 12.5f);
  EXPECT_EQ(registry.get<Emitter>(entity).maximum_drops, Emitter{}.maximum_drops);
  EXPECT_EQ(registry.get<Transform>(entity).position_m, glm::vec3(1, 2, 3));
}

TEST_F(Inspecting, ADestroyedSelectionIsNoTrouble) {
  const Entity entity = registry.create();
  registry.emplace<Light>(entity);
  InspectorState state;
  state.selected = entity;
  registry.destroy(entity);
  int widgets = -1;
  frame([&] { widgets = draw_inspector(registry, component_schemas(), state); });
  EXPECT_EQ(widgets, 0);
}

TEST_F(Inspecting, LabelsAreNamesWherePeopleGaveThem) {
  const Entity named = registry.create(), bare = registry.create();
  registry.emplace<Name>(named, Name{"toyshop_sign"});
  registry.emplace<Light>(bare);
  EXPECT_EQ(entity_label(registry, component_schemas(), named), "toyshop_sign");
  EXPECT_EQ(entity_label(registry, component_schemas(), bare).rfind("light ", 0), 0u);
}

TEST_F(Inspecting, ErrorsAndTimesAreShown) {
  InterfaceState state;
  state.show_times = state.show_inspector = true;
  state.errors = {"city.lua:12: unknown pass 'fogg'"};
  OverlayInfo info;
  info.frame_ms = {16.0f, 17.0f, 30.0f};
  info.pass_ms = {{"gbuffer", 1.5}};
  frame([&] { draw_windows(state, info, registry, component_schemas()); });
  frame([&] { draw_windows(state, info, registry, component_schemas()); });
  EXPECT_GT(ImGui::GetDrawData()->TotalVtxCount, 500);
}

TEST_F(Inspecting, TheDirectorsChoicesAreShownBeneathTheTimes) {
  InterfaceState state;
  state.show_times = true;
  OverlayInfo info;
  const auto vertices = [&] {
    for (int i = 0; i < 3; ++i) frame([&] { draw_windows(state, info, registry, component_schemas()); });
    return ImGui::GetDrawData()->TotalVtxCount;
  };
  const int without = vertices();
  info.director.push_back({"rainfall", "double_cone", 4.0, 0.6, 1.0, 2, "drop_field would need 18.2 ms, 6.1 are left"});
  const int one = vertices();
  info.director.push_back(info.director.front());
  const int two = vertices();
  EXPECT_GT(one, without + 200);
  EXPECT_GT(two, one + 200);
}

}  // namespace
}  // namespace petrichor
