#include "engine/graph/dot.hpp"

#include <fmt/format.h>

namespace petrichor {
namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') {
      out += "\\n";
    } else {
      out += c;
    }
  }
  return out;
}

std::string extent(const ResourceDesc& desc) {
  std::string text = desc.width          ? fmt::format("{}x{}", desc.width, desc.height)
                     : desc.scale == 1.0 ? "full size"
                                         : fmt::format("{:g} of full size", desc.scale);
  if (desc.layers) text += fmt::format(", {} layers", desc.layers);
  if (desc.history) text += ", history";
  if (desc.persistent) text += ", persistent";
  return text;
}

}  // namespace

std::string write_dot(const Table& table, const Plan& plan) {
  std::string out =
      "digraph frame {\n  rankdir=LR;\n  node [fontname=\"sans-serif\", fontsize=11];\n"
      "  edge [arrowsize=0.7];\n";
  std::vector<bool> alive(table.resources.size());
  for (const Storage& storage : plan.storages) {
    if (storage.first_pass >= 0) alive[storage.resource] = true;
  }
  constexpr const char* dim = ", style=dashed, color=grey70, fontcolor=grey60";
  for (std::size_t r = 0; r < table.resources.size(); ++r) {
    const ResourceDesc& desc = table.resources[r];
    const bool is_output = static_cast<int>(r) == table.output;
    out += fmt::format("  \"resource {0}\" [shape=ellipse, label=\"{0}\\n{1}, {2}\"{3}{4}];\n", escaped(desc.name),
                       desc.format->name, extent(desc), alive[r] ? "" : dim, is_output ? ", peripheries=2" : "");
  }
  for (std::size_t p = 0; p < table.passes.size(); ++p) {
    const PassNode& pass = table.passes[p];
    const bool runs = plan.passes[p].runs;
    const std::string name = escaped(pass.id);
    out += fmt::format("  \"pass {0}\" [shape=box, label=\"{1}. {0}{2}\"{3}];\n", name, p + 1,
                       runs ? "" : "\\n(" + escaped(plan.passes[p].reason) + ")",
                       runs ? ", style=filled, fillcolor=lightsteelblue" : dim);
    for (std::size_t s = 0; s < pass.connections.size(); ++s) {
      const Connection& connection = pass.connections[s];
      if (connection.resource < 0) continue;
      const Slot& slot = pass.offer->slots[s];
      const std::string resource = escaped(table.resources[connection.resource].name);
      const bool used = runs && plan.passes[p].slot_storage[s] >= 0;
      std::string style = used ? "" : ", color=grey70, fontcolor=grey60";
      if (connection.previous) style += ", style=dashed";
      const std::string label = fmt::format("label=\"{}\", fontsize=9", escaped(slot.name));
      if (slot.access == SlotAccess::read) {
        out += fmt::format("  \"resource {}\" -> \"pass {}\" [{}{}];\n", resource, name, label, style);
      } else {
        out += fmt::format("  \"pass {}\" -> \"resource {}\" [{}{}{}];\n", name, resource, label,
                           slot.access == SlotAccess::modify ? ", dir=both" : "", style);
      }
    }
  }
  return out + "}\n";
}

}  // namespace petrichor
