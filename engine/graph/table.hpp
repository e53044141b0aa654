#pragma once
// A render script's table, checked against the offers: what graph.hpp describes, in plain data. No OpenGL here.

#include <array>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/formats.hpp"
#include "engine/graph/graph.hpp"

namespace petrichor {

struct ResourceDesc {
  std::string name;
  const FormatInfo* format = nullptr;
  double scale = 1.0;         // of the output size, rounded up
  int width = 0, height = 0;  // pixels; 0: by scale
  int mips = 1;               // 0: down to one pixel
  int layers = 0;             // 0: a plain 2D texture; else a 2D array
  bool history = false;
  bool persistent = false;
  std::optional<std::array<float, 4>> clear;
};

struct Connection {
  int resource = -1;  // index into Table::resources; -1: unconnected
  bool previous = false;
};

struct PassNode {
  std::string id;
  const PassOffer* offer = nullptr;
  std::shared_ptr<PassOffer> own_offer;  // of an artist's compute pass; offer points to it
  std::vector<Connection> connections;   // one per slot of the offer
  std::unordered_map<std::string, double> parameters;
  bool enabled = true;
};

struct Table {
  std::vector<ResourceDesc> resources;
  std::vector<PassNode> passes;  // in order of execution
  int output = -1;               // resource
  int linear_output = -1;        // resource; -1: none
};

// Errors name source and place, counting as Lua does: "city.lua: passes[3] (rain_field).depth: ...".
// The offers must outlive the table.
Result<Table> read_table(const nlohmann::json& table, std::string_view source, std::span<const PassOffer> offers);

bool writes(SlotAccess access);

}  // namespace petrichor
