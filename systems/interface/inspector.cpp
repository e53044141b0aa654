#include "systems/interface/inspector.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>

#include "components/transform.hpp"

namespace petrichor {
namespace {

// ImGui compares with floats; an endless range becomes none.
float bound(double value) {
  return static_cast<float>(std::clamp(value, -3e38, 3e38));
}

// The step of a drag: a thousandth of a bounded range, else of the value's size.
float drag_speed(const Field& field, float value) {
  const double range = field.maximum - field.minimum;
  if (std::isfinite(range) && range < 1000.0) return static_cast<float>(range / 1000.0);
  return std::max(0.01f, std::abs(value) * 0.01f);
}

bool edit_integer(const char* label, const Field& field, void* at) {
  const ImGuiDataType type = field.size_bytes == 8 ? (field.is_signed ? ImGuiDataType_S64 : ImGuiDataType_U64)
                                                   : (field.is_signed ? ImGuiDataType_S32 : ImGuiDataType_U32);
  if (field.size_bytes == 8) return ImGui::DragScalar(label, type, at, 1.0f);
  if (field.is_signed) {
    const auto low = static_cast<std::int32_t>(std::max(field.minimum, -2147483648.0));
    const auto high = static_cast<std::int32_t>(std::min(field.maximum, 2147483647.0));
    return ImGui::DragScalar(label, type, at, 1.0f, &low, &high, "%d", ImGuiSliderFlags_AlwaysClamp);
  }
  const auto low = static_cast<std::uint32_t>(std::max(field.minimum, 0.0));
  const auto high = static_cast<std::uint32_t>(std::min(field.maximum, 4294967295.0));
  return ImGui::DragScalar(label, type, at, 1.0f, &low, &high, "%u", ImGuiSliderFlags_AlwaysClamp);
}

bool edit_floats(const char* label, const Field& field, float* at, int count) {
  return ImGui::DragScalarN(label, ImGuiDataType_Float, at, count, drag_speed(field, at[0]),
                            std::isfinite(field.minimum) ? std::array{bound(field.minimum)}.data() : nullptr,
                            std::isfinite(field.maximum) ? std::array{bound(field.maximum)}.data() : nullptr, "%.4g",
                            ImGuiSliderFlags_AlwaysClamp);
}

}  // namespace

bool edit_field(const Field& field, void* component) {
  void* at = field.address(component);
  const std::string label =
      field.unit.empty() ? std::string(field.name) : fmt::format("{} [{}]", field.name, field.unit);
  bool changed = false;
  switch (field.type) {
    case FieldType::boolean:
      changed = ImGui::Checkbox(label.c_str(), static_cast<bool*>(at));
      break;
    case FieldType::integer:
      changed = edit_integer(label.c_str(), field, at);
      break;
    case FieldType::real:
      if (field.size_bytes == sizeof(double))
        changed = ImGui::DragScalar(label.c_str(), ImGuiDataType_Double, at, 0.01f);
      else
        changed = edit_floats(label.c_str(), field, static_cast<float*>(at), 1);
      break;
    case FieldType::vec2:
      changed = edit_floats(label.c_str(), field, static_cast<float*>(at), 2);
      break;
    case FieldType::vec3:
      changed = edit_floats(label.c_str(), field, static_cast<float*>(at), 3);
      break;
    case FieldType::colour:
      changed = ImGui::ColorEdit3(label.c_str(), static_cast<float*>(at),
                                  ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR);
      break;
    case FieldType::rotation: {
      auto* q = static_cast<glm::quat*>(at);
      float xyzw[4] = {q->x, q->y, q->z, q->w};
      changed = ImGui::DragFloat4(label.c_str(), xyzw, 0.01f, -1.0f, 1.0f);
      const glm::quat edited(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
      if (changed && glm::length(edited) > 1e-3f) *q = glm::normalize(edited);
      break;
    }
    case FieldType::text:
      changed = ImGui::InputText(label.c_str(), static_cast<std::string*>(at));
      break;
    case FieldType::choice: {
      int chosen = 0;
      std::memcpy(&chosen, at, std::min(field.size_bytes, sizeof(chosen)));
      const std::string shown =
          chosen >= 0 && chosen < static_cast<int>(field.choices.size()) ? std::string(field.choices[chosen]) : "?";
      if (ImGui::BeginCombo(label.c_str(), shown.c_str())) {
        for (int i = 0; i < static_cast<int>(field.choices.size()); ++i)
          if (ImGui::Selectable(std::string(field.choices[i]).c_str(), i == chosen)) {
            std::memcpy(at, &i, std::min(field.size_bytes, sizeof(i)));
            changed = true;
          }
        ImGui::EndCombo();
      }
      break;
    }
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(field.meaning).c_str());
  return changed;
}

std::string entity_label(Registry& registry, std::span<const Schema> schemas, Entity entity) {
  if (const auto* name = registry.find<Name>(entity); name && !name->text.empty()) return name->text;
  for (const Schema& schema : schemas)
    if (schema.name != "transform" && schema.find(registry, entity))
      return fmt::format("{} {}", schema.name, entity.bits);
  return fmt::format("entity {}", entity.bits);
}

int draw_inspector(Registry& registry, std::span<const Schema> schemas, InspectorState& state) {
  int widgets = 0;
  if (!ImGui::Begin("Inspector")) {
    ImGui::End();
    return widgets;
  }
  ImGui::InputTextWithHint("##filter", "component or name", state.filter, sizeof(state.filter));
  const std::string filter = state.filter;
  // What people came to change stands first: the rarer a component, the more it says.
  ImGui::BeginChild("entities", ImVec2(0, 180), true);
  std::set<std::uint32_t> listed;
  for (const Schema& schema : schemas) {
    if (schema.name == "transform" || schema.name == "name" || schema.name == "mesh_instance") continue;
    const bool schema_fits = filter.empty() || schema.name.find(filter) != std::string_view::npos;
    for (const Entity entity : schema.entities(registry)) {
      const std::string label = entity_label(registry, schemas, entity);
      if (!schema_fits && label.find(filter) == std::string::npos) continue;
      if (!listed.insert(entity.bits).second) continue;
      if (ImGui::Selectable(fmt::format("{}: {}##{}", schema.name, label, entity.bits).c_str(),
                            entity == state.selected))
        state.selected = entity;
    }
  }
  ImGui::EndChild();
  if (registry.alive(state.selected)) {
    for (const Schema& schema : schemas) {
      void* component = schema.find(registry, state.selected);
      if (!component) continue;
      ImGui::PushID(std::string(schema.name).c_str());
      if (ImGui::CollapsingHeader(std::string(schema.name).c_str(), ImGuiTreeNodeFlags_DefaultOpen)) {
        for (const Field& field : schema.fields) {
          edit_field(field, component);
          ++widgets;
        }
      }
      ImGui::PopID();
    }
  }
  ImGui::End();
  return widgets;
}

}  // namespace petrichor
