#include "engine/ecs/schema_reference.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace petrichor {
namespace {

// A bar would end the cell, an angle bracket could begin HTML.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '\\') out += '\\';
    if (c == '<')
      out += "&lt;";
    else if (c == '\n')
      out += ' ';
    else
      out += c;
  }
  return out;
}

// A float as people write it: 0.06, not 0.05999999865889549.
std::string shortest(const nlohmann::json& value, bool is_single) {
  if (value.is_array()) {
    std::string out = "[";
    for (const auto& element : value) out += (out.size() > 1 ? ", " : "") + shortest(element, is_single);
    return out + "]";
  }
  if (value.is_number_float() && is_single) return fmt::format("{}", value.get<float>());
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::string field_type_words(const Field& f) {
  switch (f.type) {
    case FieldType::boolean:
      return "true or false";
    case FieldType::integer:
      return "whole number";
    case FieldType::real:
      return "number";
    case FieldType::vec2:
      return "[x, y]";
    case FieldType::vec3:
      return "[x, y, z]";
    case FieldType::colour:
      return "[r, g, b], linear";
    case FieldType::rotation:
      return "[x, y, z, w], unit quaternion";
    case FieldType::text:
      return "text";
    case FieldType::choice:
      break;
  }
  std::string out;
  for (std::size_t i = 0; i < f.choices.size(); ++i) {
    if (i > 0) out += i + 1 == f.choices.size() ? " or " : ", ";
    out += fmt::format("\"{}\"", f.choices[i]);
  }
  return out;
}

std::string field_range_words(const Field& f) {
  const bool low = std::isfinite(f.minimum), high = std::isfinite(f.maximum);
  if (low && high) return fmt::format("{} to {}", f.minimum, f.maximum);
  if (low) return fmt::format("at least {}", f.minimum);
  if (high) return fmt::format("at most {}", f.maximum);
  return {};
}

std::string schema_reference(std::span<const Schema> schemas) {
  std::string page =
      "# Components\n\n"
      "Made from the schemas; do not edit. A script, the `extras` of a glTF node and `--set` write these fields; a\n"
      "value of another type or outside its range is an error.\n\n";
  for (const Schema& s : schemas) page += fmt::format("- [{0}](#{0})\n", s.name);
  for (const Schema& s : schemas) {
    Registry registry;
    const void* fresh = s.emplace(registry, registry.create());
    page += fmt::format("\n## {}\n\n{}\n", s.name, s.meaning);
    if (s.fields.empty()) continue;
    page += "\n| field | type | unit | default | range | meaning |\n|---|---|---|---|---|---|\n";
    for (const Field& f : s.fields) {
      const bool is_single = f.type != FieldType::real || f.size_bytes == sizeof(float);
      page += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", f.name, cell(field_type_words(f)), cell(f.unit),
                          cell(shortest(read_field(f, fresh), is_single)), field_range_words(f), cell(f.meaning));
    }
  }
  return page;
}

}  // namespace petrichor
