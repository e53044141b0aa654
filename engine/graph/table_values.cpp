#include "engine/graph/table_values.hpp"

#include <cmath>

#include "engine/core/names.hpp"

namespace petrichor {

using nlohmann::json;

bool is_map(const json& value) {
  return value.is_object() || (value.is_array() && value.empty());
}

tl::unexpected<Error> unknown(const Place& at, std::string_view what, std::string_view name,
                              std::vector<std::string_view> known) {
  if (known.empty()) return at.error(fmt::format("unknown {} \"{}\"; there is none", what, name));
  return at.error(fmt::format("unknown {} \"{}\"{}", what, name, name_hint(name, known)));
}

Result<double> read_number(const Place& at, const json& value, double least, double most) {
  if (!value.is_number()) return at.error(fmt::format("expected a number, got {}", value.type_name()));
  const double v = value.get<double>();
  if (!(v >= least && v <= most)) return at.error(fmt::format("{} is outside {} to {}", v, least, most));
  return v;
}

Result<int> read_whole(const Place& at, const json& value, int least, int most) {
  auto v = read_number(at, value, least, most);
  if (!v) return tl::unexpected(v.error());
  if (*v != std::floor(*v)) return at.error(fmt::format("expected a whole number, got {}", *v));
  return static_cast<int>(*v);
}

Result<bool> read_boolean(const Place& at, const json& value) {
  if (!value.is_boolean()) return at.error(fmt::format("expected true or false, got {}", value.type_name()));
  return value.get<bool>();
}

Result<std::string> read_text(const Place& at, const json& value) {
  if (!value.is_string()) return at.error(fmt::format("expected a string, got {}", value.type_name()));
  return value.get<std::string>();
}

Result<std::vector<double>> read_numbers(const Place& at, const json& value) {
  if (value.is_boolean()) return std::vector<double>{value.get<bool>() ? 1.0 : 0.0};
  const json list = value.is_array() ? value : json::array({value});
  std::vector<double> out;
  for (const json& item : list) {
    if (!item.is_number())
      return at.error(fmt::format("expected a number or a list of 1 to 4, got {}", item.type_name()));
    out.push_back(item.get<double>());
  }
  if (out.empty() || out.size() > 4) return at.error(fmt::format("expected 1 to 4 numbers, got {}", out.size()));
  return out;
}

}  // namespace petrichor
