#include "systems/interface/interface.hpp"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>

namespace petrichor {
namespace {

void draw_times(const OverlayInfo& info) {
  ImGui::SetNextWindowPos(ImVec2(10, 10), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowBgAlpha(0.6f);
  if (ImGui::Begin("Times", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
    std::vector<float> sorted = info.frame_ms;
    std::sort(sorted.begin(), sorted.end());
    if (!sorted.empty()) {
      const float median = sorted[sorted.size() / 2], p95 = sorted[sorted.size() * 95 / 100];
      ImGui::Text("%.2f ms a frame (p95 %.2f), %.0f a second", median, p95, 1000.0f / std::max(median, 1e-3f));
      ImGui::PlotLines("##frames", info.frame_ms.data(), static_cast<int>(info.frame_ms.size()), 0, nullptr, 0.0f,
                       std::max(p95 * 1.5f, 1.0f), ImVec2(280, 50));
    }
    ImGui::Text("rain %.1f mm/h, %llu drops drawn", info.rain_mm_per_hour,
                static_cast<unsigned long long>(info.drops_drawn));
    ImGui::TextUnformatted(info.device.c_str());
    ImGui::Separator();
    for (const Timing& pass : info.pass_ms) ImGui::Text("%8.3f ms  %s", pass.milliseconds, pass.name.c_str());
  }
  ImGui::End();
}

// Beneath the times: the budget, and by what each effect is drawn.
void draw_director(InterfaceState& state, const OverlayInfo& info) {
  if (ImGui::Begin("Times")) {
    ImGui::Separator();
    ImGui::Checkbox("the director keeps frames within", &state.directed);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(80.0f);
    ImGui::DragFloat("ms", &state.budget_ms, 0.25f, 1.0f, 1000.0f, "%.1f", ImGuiSliderFlags_AlwaysClamp);
    for (const DirectorNote& note : info.director) {
      ImGui::Text("%8.2f ms  %s=%s, error %.2f of %.0f%%", note.ms, note.effect.c_str(), note.rung.c_str(), note.error,
                  note.coverage * 100.0);
      ImGui::TextDisabled("             %s", note.why.c_str());
    }
  }
  ImGui::End();
}

void draw_errors(std::vector<std::string>& errors) {
  if (errors.empty()) return;
  ImGui::SetNextWindowPos(ImVec2(10, 300), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize(ImVec2(700, 0), ImGuiCond_FirstUseEver);
  if (ImGui::Begin("Something is wrong; the last good state goes on")) {
    for (const std::string& error : errors) {
      ImGui::PushTextWrapPos(0.0f);
      ImGui::TextUnformatted(error.c_str());
      ImGui::PopTextWrapPos();
      ImGui::Separator();
    }
    if (ImGui::Button("Close")) errors.clear();
  }
  ImGui::End();
}

}  // namespace

Interface::Interface(void* glfw_window) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // nothing is left in the working folder
  ImGui::StyleColorsDark();
  ImGui_ImplGlfw_InitForOpenGL(static_cast<GLFWwindow*>(glfw_window), true);
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

Interface::~Interface() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

bool Interface::wants_mouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}
bool Interface::wants_keyboard() const {
  return ImGui::GetIO().WantCaptureKeyboard;
}

void Interface::draw(InterfaceState& state, const OverlayInfo& info, Registry& registry,
                     std::span<const Schema> schemas) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  draw_windows(state, info, registry, schemas);
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void draw_windows(InterfaceState& state, const OverlayInfo& info, Registry& registry, std::span<const Schema> schemas) {
  if (state.show_times) {
    draw_times(info);
    if (!info.director.empty()) draw_director(state, info);
  }
  if (state.show_inspector) {
    ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x - 410, 10), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(400, 600), ImGuiCond_FirstUseEver);
    draw_inspector(registry, schemas, state.inspector);
  }
  draw_errors(state.errors);
}

}  // namespace petrichor
