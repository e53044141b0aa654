#include "engine/graph/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/graph/artist_pass.hpp"
#include "engine/graph/table_values.hpp"

namespace petrichor {
namespace {

using nlohmann::json;

constexpr int kMaxPixels = 16384;  // OpenGL 4.5's least GL_MAX_TEXTURE_SIZE
constexpr FormatInfo kNoTexture{"none", GL_NONE, 0, false, false, false};
constexpr std::string_view kPrevious = "previous:";
// Keys of a pass that are no slots; "1" is how {"gbuffer", depth = "depth"} arrives from Lua.
constexpr std::string_view kPassKeys[] = {"pass", "1", "id", "parameters", "enabled"};
constexpr std::string_view kComputeKeys[] = {"compute", "name", "read", "write", "modify", "parameters", "enabled"};

bool is_one_of(std::string_view key, std::span<const std::string_view> keys) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

// target = the value of a Result, or its error to the caller.
#define PETRICHOR_TAKE(target, expression)                       \
  do {                                                           \
    auto taken = (expression);                                   \
    if (!taken) return tl::unexpected(std::move(taken.error())); \
    target = *std::move(taken);                                  \
  } while (false)

Result<ResourceDesc> read_resource(const Place& at, const std::string& name, const json& value) {
  ResourceDesc desc{name};
  if (name.find(':') != name.npos) return at.error("a resource's name holds no \":\"");
  if (!is_map(value)) return at.error(fmt::format("expected a table, got {}", value.type_name()));
  bool has_scale = false;
  for (const auto& [key, v] : value.items()) {
    const Place here = at / key;
    if (key == "format") {
      std::string format;
      PETRICHOR_TAKE(format, read_text(here, v));
      desc.format = format == kNoTexture.name ? &kNoTexture : find_format(format);
      if (!desc.format) {
        std::vector<std::string_view> known;
        for (const FormatInfo& info : known_formats()) known.push_back(info.name);
        known.push_back(kNoTexture.name);
        return unknown(here, "format", format, std::move(known));
      }
    } else if (key == "scale") {
      PETRICHOR_TAKE(desc.scale, read_number(here, v, 1.0 / 256, 8));
      has_scale = true;
    } else if (key == "width") {
      PETRICHOR_TAKE(desc.width, read_whole(here, v, 1, kMaxPixels));
    } else if (key == "height") {
      PETRICHOR_TAKE(desc.height, read_whole(here, v, 1, kMaxPixels));
    } else if (key == "mips") {
      PETRICHOR_TAKE(desc.mips, read_whole(here, v, 0, 15));
    } else if (key == "layers") {
      PETRICHOR_TAKE(desc.layers, read_whole(here, v, 1, 2048));
    } else if (key == "history") {
      PETRICHOR_TAKE(desc.history, read_boolean(here, v));
    } else if (key == "persistent") {
      PETRICHOR_TAKE(desc.persistent, read_boolean(here, v));
    } else if (key == "clear") {
      std::vector<double> values;
      PETRICHOR_TAKE(values, read_numbers(here, v));
      std::array<float, 4> clear{};
      // One number means all channels, as in clear = 1.
      for (std::size_t i = 0; i < 4; ++i) {
        clear[i] = static_cast<float>(values.size() == 1 ? values[0] : i < values.size() ? values[i] : 0.0);
      }
      desc.clear = clear;
    } else {
      return unknown(at, "key", key,
                     {"format", "scale", "width", "height", "mips", "layers", "history", "persistent", "clear"});
    }
  }
  if (!desc.format) return at.error("format is missing, as in format = \"rgba16f\"");
  if ((desc.width == 0) != (desc.height == 0)) return at.error("width and height go together");
  if (has_scale && desc.width) return at.error("has both scale and width/height; give one");
  if (desc.format == &kNoTexture && (desc.history || desc.persistent || desc.clear)) {
    return at.error("has no texture (format \"none\"), so history, persistent and clear mean nothing");
  }
  if (desc.history && desc.persistent) return at.error("is both history and persistent; give one");
  return desc;
}

class TableReader {
 public:
  TableReader(std::string_view source, std::span<const PassOffer> offers)
      : root_{std::string(source)}, offers_(offers) {}

  Result<Table> read(const json& value) {
    if (!value.is_object()) return root_.error("the render script returns a table with resources, passes and output");
    for (const auto& [key, v] : value.items()) {
      if (key != "resources" && key != "passes" && key != "output" && key != "linear_output") {
        return unknown(root_, "key", key, {"resources", "passes", "output", "linear_output"});
      }
    }
    if (auto done = resources(value); !done) return tl::unexpected(done.error());
    if (auto done = passes(value); !done) return tl::unexpected(done.error());
    if (!value.contains("output")) return root_.error("output is missing: name the resource to show");
    PETRICHOR_TAKE(table_.output, output(value, "output"));
    if (value.contains("linear_output")) PETRICHOR_TAKE(table_.linear_output, output(value, "linear_output"));
    if (auto done = order(); !done) return tl::unexpected(done.error());
    return std::move(table_);
  }

 private:
  Place at(std::string_view where) const { return {fmt::format("{}: {}", root_.text, where)}; }

  Result<void> resources(const json& value) {
    const auto found = value.find("resources");
    if (found == value.end()) return root_.error("resources is missing");
    if (!is_map(*found)) return at("resources").error("expected a table of NAME = { format = ... }");
    for (const auto& [name, v] : found->items()) {
      auto desc = read_resource(at("resources") / name, name, v);
      if (!desc) return tl::unexpected(desc.error());
      table_.resources.push_back(*std::move(desc));
    }
    return {};
  }

  Result<void> passes(const json& value) {
    const auto found = value.find("passes");
    if (found == value.end()) return root_.error("passes is missing");
    if (!found->is_array()) return at("passes").error("expected a list of passes");
    std::set<std::string> ids;
    for (std::size_t i = 0; i < found->size(); ++i) {
      const json& v = (*found)[i];
      const Place here = at(fmt::format("passes[{}]", i + 1));
      if (!v.is_object()) return here.error(fmt::format("expected a table, got {}", v.type_name()));
      auto node = v.contains("compute") ? compute_pass(here, v) : offered_pass(here, v);
      if (!node) return tl::unexpected(node.error());
      places_.push_back({fmt::format("{} ({})", here.text, node->id)});
      if (!ids.insert(node->id).second) {
        return here.error(
            fmt::format("a second pass \"{}\"; give it an id of its own, as in id = \"{}_2\"", node->id, node->id));
      }
      if (auto done = hazards(*node); !done) return tl::unexpected(done.error());
      table_.passes.push_back(*std::move(node));
    }
    return {};
  }

  Result<int> output(const json& value, const char* key) const {
    std::string name;
    PETRICHOR_TAKE(name, read_text(at(key), value[key]));
    Connection connection;
    PETRICHOR_TAKE(connection, resource(at(key), name));
    if (connection.previous) return at(key).error("is last frame's; name the resource itself");
    return connection.resource;
  }

  Result<Connection> resource(const Place& here, const std::string& name) const {
    Connection connection;
    connection.previous = name.starts_with(kPrevious);
    const std::string_view bare = connection.previous ? std::string_view(name).substr(kPrevious.size()) : name;
    for (std::size_t i = 0; i < table_.resources.size(); ++i) {
      if (table_.resources[i].name == bare) connection.resource = static_cast<int>(i);
    }
    if (connection.resource < 0) {
      std::vector<std::string_view> known;
      for (const ResourceDesc& desc : table_.resources) known.push_back(desc.name);
      return unknown(here, "resource", bare, std::move(known));
    }
    if (connection.previous && !table_.resources[connection.resource].history) {
      return here.error(fmt::format("\"{}\" keeps no history; declare it with history = true", bare));
    }
    return connection;
  }

  Result<Connection> connect(const Place& here, const json& value, const Slot& slot) const {
    std::string name;
    PETRICHOR_TAKE(name, read_text(here, value));
    Connection connection;
    PETRICHOR_TAKE(connection, resource(here, name));
    if (connection.previous && slot.access != SlotAccess::read) {
      return here.error(fmt::format("last frame's {} can only be read", table_.resources[connection.resource].name));
    }
    return connection;
  }

  Result<PassNode> offered_pass(const Place& here, const json& value) {
    const auto key = value.contains("pass") ? value.find("pass") : value.find("1");
    if (key == value.end())
      return here.error("names no pass: write { pass = \"name\", ... } or { compute = \"file\", ... }");
    PassNode node;
    PETRICHOR_TAKE(node.id, read_text(here / "pass", *key));
    for (const PassOffer& offer : offers_) {
      if (offer.name == node.id) node.offer = &offer;
    }
    if (!node.offer) {
      std::vector<std::string_view> known;
      for (const PassOffer& offer : offers_) known.push_back(offer.name);
      return unknown(here, "pass", node.id, std::move(known));
    }
    const PassOffer& offer = *node.offer;
    const Place named{fmt::format("{} ({})", here.text, offer.name)};
    node.connections.resize(offer.slots.size());
    node.parameters = offer.parameters;
    for (const auto& [k, v] : value.items()) {
      if (k == "id") {
        PETRICHOR_TAKE(node.id, read_text(named / k, v));
      } else if (k == "enabled") {
        PETRICHOR_TAKE(node.enabled, read_boolean(named / k, v));
      } else if (k == "parameters") {
        if (auto done = parameters(named / k, v, node); !done) return tl::unexpected(done.error());
      } else if (!is_one_of(k, kPassKeys)) {
        const auto slot =
            std::find_if(offer.slots.begin(), offer.slots.end(), [&](const Slot& s) { return s.name == k; });
        if (slot == offer.slots.end()) {
          std::vector<std::string_view> known;
          for (const Slot& s : offer.slots) known.push_back(s.name);
          return unknown(named, "slot", k, std::move(known));
        }
        PETRICHOR_TAKE(node.connections[slot - offer.slots.begin()], connect(named / k, v, *slot));
      }
    }
    for (std::size_t i = 0; i < offer.slots.size(); ++i) {
      const Slot& slot = offer.slots[i];
      if (node.connections[i].resource < 0 && !slot.optional) {
        return named.error(fmt::format("slot \"{}\" is not connected: name the resource that it {}", slot.name,
                                       slot.access == SlotAccess::read    ? "reads"
                                       : slot.access == SlotAccess::write ? "writes"
                                                                          : "modifies"));
      }
    }
    return node;
  }

  static Result<void> parameters(const Place& here, const json& value, PassNode& node) {
    if (!is_map(value)) return here.error(fmt::format("expected a table of name = number, got {}", value.type_name()));
    for (const auto& [name, v] : value.items()) {
      const auto known = node.parameters.find(name);
      if (known == node.parameters.end()) {
        std::vector<std::string_view> names;
        for (const auto& [n, unused] : node.offer->parameters) names.push_back(n);
        std::sort(names.begin(), names.end());
        return unknown(here, "parameter", name, std::move(names));
      }
      if (v.is_boolean()) {
        known->second = v.get<bool>() ? 1.0 : 0.0;
      } else {
        PETRICHOR_TAKE(known->second, read_number(here / name, v, -1e30, 1e30));
      }
    }
    return {};
  }

  Result<PassNode> compute_pass(const Place& here, const json& value) {
    for (const auto& [k, v] : value.items()) {
      if (!is_one_of(k, kComputeKeys))
        return unknown(here, "key", k, {std::begin(kComputeKeys), std::end(kComputeKeys)});
    }
    PassNode node;
    ArtistPass artist;
    PETRICHOR_TAKE(artist.file, read_text(here / "compute", value.at("compute")));
    if (!artist.file.ends_with(".comp.glsl")) {
      return (here / "compute").error(fmt::format("\"{}\": a compute shader's name ends in .comp.glsl", artist.file));
    }
    node.id = artist.file.substr(artist.file.find_last_of('/') + 1);
    node.id.resize(node.id.size() - std::string_view(".comp.glsl").size());
    if (value.contains("name")) PETRICHOR_TAKE(node.id, read_text(here / "name", value["name"]));
    if (value.contains("enabled")) PETRICHOR_TAKE(node.enabled, read_boolean(here / "enabled", value["enabled"]));
    const Place named{fmt::format("{} ({})", here.text, node.id)};

    std::vector<Slot> slots;
    for (const auto& [group, access] : {std::pair{"read", SlotAccess::read}, std::pair{"write", SlotAccess::write},
                                        std::pair{"modify", SlotAccess::modify}}) {
      if (!value.contains(group)) continue;
      const Place group_place = named / group;
      if (!is_map(value[group])) return group_place.error("expected a table of UNIFORM = \"resource\"");
      for (const auto& [uniform, v] : value[group].items()) {
        const Slot slot{uniform, access};
        Connection connection;
        PETRICHOR_TAKE(connection, connect(group_place / uniform, v, slot));
        const ResourceDesc& desc = table_.resources[connection.resource];
        if (desc.format == &kNoTexture) {
          return (group_place / uniform).error(fmt::format("\"{}\" has no texture", desc.name));
        }
        if (writes(access) && !desc.format->image) {
          return (group_place / uniform)
              .error(fmt::format("\"{}\" is {}, which no compute shader can write", desc.name, desc.format->name));
        }
        if (std::any_of(slots.begin(), slots.end(), [&](const Slot& s) { return s.name == uniform; })) {
          return (group_place / uniform).error("is named twice in this pass");
        }
        slots.push_back(slot);
        node.connections.push_back(connection);
        (access == SlotAccess::read ? artist.samplers : artist.images).push_back(uniform);
      }
    }
    if (artist.images.empty()) return named.error("writes nothing: give write = { IMAGE = \"resource\" }");
    if (value.contains("parameters")) {
      const Place parameters_place = named / "parameters";
      if (!is_map(value["parameters"])) return parameters_place.error("expected a table of UNIFORM = value");
      for (const auto& [uniform, v] : value["parameters"].items()) {
        PETRICHOR_TAKE(artist.uniforms[uniform], read_numbers(parameters_place / uniform, v));
      }
    }
    artist.id = node.id;
    node.own_offer = make_artist_offer(std::move(artist));
    node.own_offer->slots = std::move(slots);
    node.offer = node.own_offer.get();
    return node;
  }

  // One resource in two slots of a pass. Reading the old and writing the new version is fine: they are two textures.
  Result<void> hazards(const PassNode& node) const {
    for (std::size_t i = 0; i < node.connections.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Connection& a = node.connections[i];
        const Connection& b = node.connections[j];
        if (a.resource < 0 || a.resource != b.resource || a.previous || b.previous) continue;
        const SlotAccess x = node.offer->slots[i].access, y = node.offer->slots[j].access;
        if (!writes(x) && !writes(y)) continue;
        const ResourceDesc& desc = table_.resources[a.resource];
        const bool read_and_write =
            (x == SlotAccess::read && y == SlotAccess::write) || (y == SlotAccess::read && x == SlotAccess::write);
        if (read_and_write && !desc.persistent) continue;
        return places_.back().error(
            fmt::format("slots \"{}\" and \"{}\" are both \"{}\", which would be read and written "
                        "at once; use two resources",
                        node.offer->slots[j].name, node.offer->slots[i].name, desc.name));
      }
    }
    return {};
  }

  // Every read has a writer before it (or content of its own), the output has one at all.
  Result<void> order() const {
    std::vector<bool> ever(table_.resources.size()), written(table_.resources.size());
    const auto each = [&](auto&& visit) -> Result<void> {
      for (std::size_t p = 0; p < table_.passes.size(); ++p) {
        for (std::size_t s = 0; s < table_.passes[p].connections.size(); ++s) {
          const Connection& connection = table_.passes[p].connections[s];
          if (connection.resource < 0) continue;
          if (Result<void> done = visit(p, s, connection); !done) return done;
        }
      }
      return {};
    };
    const auto access = [&](std::size_t p, std::size_t s) { return table_.passes[p].offer->slots[s].access; };
    (void)each([&](std::size_t p, std::size_t s, const Connection& c) -> Result<void> {
      if (writes(access(p, s))) ever[c.resource] = true;
      return {};
    });
    std::size_t settled = 0;  // passes before it have had their writes entered
    auto done = each([&](std::size_t p, std::size_t s, const Connection& c) -> Result<void> {
      for (; settled < p; ++settled) {
        for (std::size_t k = 0; k < table_.passes[settled].connections.size(); ++k) {
          const Connection& w = table_.passes[settled].connections[k];
          if (w.resource >= 0 && writes(access(settled, k))) written[w.resource] = true;
        }
      }
      const ResourceDesc& desc = table_.resources[c.resource];
      if (access(p, s) == SlotAccess::write || written[c.resource] || desc.clear) return {};
      if ((c.previous || desc.persistent) && ever[c.resource]) return {};
      const Place here = places_[p] / table_.passes[p].offer->slots[s].name;
      if (!ever[c.resource]) return here.error(fmt::format("\"{}\" is read but no pass writes it", desc.name));
      return here.error(fmt::format("\"{}\" is read before any pass has written it; move the pass down", desc.name));
    });
    if (!done) return done;
    for (const auto& [key, resource] :
         {std::pair{"output", table_.output}, std::pair{"linear_output", table_.linear_output}}) {
      if (resource < 0 || ever[resource]) continue;
      return at(key).error(fmt::format("no pass writes \"{}\"", table_.resources[resource].name));
    }
    return {};
  }

  Place root_;
  std::span<const PassOffer> offers_;
  Table table_;
  std::vector<Place> places_;  // of each pass
};

#undef PETRICHOR_TAKE

}  // namespace

bool writes(SlotAccess access) {
  return access != SlotAccess::read;
}

Result<Table> read_table(const json& table, std::string_view source, std::span<const PassOffer> offers) {
  return TableReader(source, offers).read(table);
}

}  // namespace petrichor
