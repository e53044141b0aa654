#pragma once
// Values of a script's table, each read with an error that says where it stands. Private to engine/graph.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace petrichor {

// Where in the table: "city.lua: passes[3] (rain_field).depth".
struct Place {
  std::string text;
  Place operator/(std::string_view key) const { return {fmt::format("{}.{}", text, key)}; }
  tl::unexpected<Error> error(std::string_view message) const { return failure(fmt::format("{}: {}", text, message)); }
};

// Lua cannot tell an empty list from an empty map.
bool is_map(const nlohmann::json& value);

// `unknown slot "dept"; did you mean "depth"? Known: ...`
tl::unexpected<Error> unknown(const Place& at, std::string_view what, std::string_view name,
                              std::vector<std::string_view> known);

Result<double> read_number(const Place& at, const nlohmann::json& value, double least, double most);
Result<int> read_whole(const Place& at, const nlohmann::json& value, int least, int most);
Result<bool> read_boolean(const Place& at, const nlohmann::json& value);
Result<std::string> read_text(const Place& at, const nlohmann::json& value);
// One number, a list of 1 to 4, or true and false as 1 and 0.
Result<std::vector<double>> read_numbers(const Place& at, const nlohmann::json& value);

}  // namespace petrichor
