#include "engine/graph/plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petrichor {
namespace {

struct Version {
  int storage = -1;
  int writer = -1;  // pass; -1: content from before the frame (clear, persistent)
  int base = -1;    // the version that a modify goes on from
  bool needed = false;
};

class Planner {
 public:
  Planner(const Table& table, const std::vector<bool>& wanted, int width, int height)
      : table_(table), width_(width), height_(height), nodes_(table.passes.size()) {
    plan_.passes.resize(table.passes.size());
    current_.assign(table.resources.size(), -1);
    previous_.assign(table.resources.size(), -1);
    go_forward(wanted);
    walk_back();
    place_storages();
    share_textures();
  }
  Plan take() { return std::move(plan_); }

 private:
  // What a pass touches, if it runs.
  struct Node {
    bool possible = false;
    std::vector<int> slot_version;  // read: the version read; write and modify: the version made; -1: none
    std::vector<bool> slot_previous;
  };

  int new_storage(int resource, StorageKind kind) {
    Storage storage;
    storage.resource = resource;
    storage.kind = kind;
    storage.clear_first = kind == StorageKind::transient && table_.resources[resource].clear.has_value();
    plan_.storages.push_back(storage);
    return static_cast<int>(plan_.storages.size()) - 1;
  }

  int new_version(int resource, int storage, int writer, int base) {
    versions_.push_back({storage, writer, base});
    return current_[resource] = static_cast<int>(versions_.size()) - 1;
  }

  // In table order: which passes could run, and which version each slot then sees.
  void go_forward(const std::vector<bool>& wanted) {
    for (std::size_t r = 0; r < table_.resources.size(); ++r) {
      const ResourceDesc& desc = table_.resources[r];
      const int resource = static_cast<int>(r);
      if (desc.persistent) {
        new_version(resource, new_storage(resource, StorageKind::persistent), -1, -1);
        persistent_start_.push_back(current_[r]);
      } else if (desc.clear) {
        new_version(resource, new_storage(resource, StorageKind::transient), -1, -1);
      }
    }
    for (std::size_t p = 0; p < table_.passes.size(); ++p) {
      const PassNode& pass = table_.passes[p];
      PassPlan& plan = plan_.passes[p];
      Node& node = nodes_[p];
      node.slot_version.assign(pass.connections.size(), -1);
      node.slot_previous.assign(pass.connections.size(), false);
      plan.slot_storage.assign(pass.connections.size(), -1);
      if (!pass.enabled) {
        plan.reason = "switched off in the script";
      } else if (!wanted[p]) {
        plan.reason = "no component asks for it";
      } else {
        plan.reason = missing_input(static_cast<int>(p));
      }
      node.possible = plan.reason.empty();
      if (node.possible) connect(static_cast<int>(p));
    }
    final_ = current_;
    // The last version of a history resource is what next frame calls previous.
    for (std::size_t r = 0; r < table_.resources.size(); ++r) {
      if (table_.resources[r].history && final_[r] >= 0) {
        plan_.storages[versions_[final_[r]].storage].kind = StorageKind::history_now;
      }
    }
  }

  std::string missing_input(int p) const {
    const PassNode& pass = table_.passes[p];
    for (std::size_t s = 0; s < pass.connections.size(); ++s) {
      const Connection& connection = pass.connections[s];
      const Slot& slot = pass.offer->slots[s];
      if (connection.resource < 0 || connection.previous || slot.optional || slot.access == SlotAccess::write) continue;
      if (current_[connection.resource] < 0) {
        return fmt::format("{} has no content: {}", table_.resources[connection.resource].name,
                           why_unwritten(connection.resource, p));
      }
    }
    return {};
  }

  // The passes before `before` that would have written it, and why they did not.
  std::string why_unwritten(int resource, int before) const {
    std::vector<std::string> lines;
    for (int p = 0; p < before; ++p) {
      const PassNode& pass = table_.passes[p];
      for (std::size_t s = 0; s < pass.connections.size(); ++s) {
        if (pass.connections[s].resource == resource && writes(pass.offer->slots[s].access)) {
          lines.push_back(fmt::format("{} does not run ({})", pass.id, plan_.passes[p].reason));
        }
      }
    }
    return lines.empty() ? "no pass writes it" : fmt::format("{}", fmt::join(lines, ", "));
  }

  void connect(int p) {
    const PassNode& pass = table_.passes[p];
    Node& node = nodes_[p];
    const auto each = [&](auto&& visit) {
      for (std::size_t s = 0; s < pass.connections.size(); ++s) {
        if (pass.connections[s].resource >= 0) visit(s, pass.connections[s], pass.offer->slots[s].access);
      }
    };
    each([&](std::size_t s, const Connection& c, SlotAccess access) {  // reads see what was before the pass
      if (access != SlotAccess::read) return;
      node.slot_previous[s] = c.previous;
      if (!c.previous) {
        node.slot_version[s] = current_[c.resource];
      } else if (previous_[c.resource] < 0) {
        previous_[c.resource] = new_storage(c.resource, StorageKind::history_previous);
      }
    });
    each([&](std::size_t s, const Connection& c, SlotAccess access) {
      const int base = current_[c.resource];
      if (access == SlotAccess::modify && base >= 0) {
        node.slot_version[s] = new_version(c.resource, versions_[base].storage, p, base);
      } else if (access == SlotAccess::write) {
        const bool kept = table_.resources[c.resource].persistent;
        const int storage = kept ? versions_[base].storage : new_storage(c.resource, StorageKind::transient);
        node.slot_version[s] = new_version(c.resource, storage, p, -1);
      }
    });
  }

  // From the output and from passes with effects of their own, back to all they need.
  void walk_back() {
    for (std::size_t p = 0; p < nodes_.size(); ++p) {
      const std::vector<Slot>& slots = table_.passes[p].offer->slots;
      const bool no_outputs = std::none_of(slots.begin(), slots.end(), [](const Slot& s) { return writes(s.access); });
      if (nodes_[p].possible && (no_outputs || table_.passes[p].offer->side_effect)) run(static_cast<int>(p));
    }
    if (final_[table_.output] >= 0) {
      need(final_[table_.output]);
      plan_.output_storage = versions_[final_[table_.output]].storage;
    } else {
      plan_.error = fmt::format("the output \"{}\" has no content: {}", table_.resources[table_.output].name,
                                why_unwritten(table_.output, static_cast<int>(nodes_.size())));
    }
    // Looked at beside the picture, where something writes it: it makes passes run, and fails nothing.
    if (table_.linear_output >= 0 && final_[table_.linear_output] >= 0) {
      need(final_[table_.linear_output]);
      plan_.linear_output_storage = versions_[final_[table_.linear_output]].storage;
    }
    for (std::size_t p = 0; p < nodes_.size(); ++p) {
      if (nodes_[p].possible && !plan_.passes[p].runs) plan_.passes[p].reason = unread(static_cast<int>(p));
    }
  }

  void need(int version) {
    if (version < 0 || versions_[version].needed) return;
    versions_[version].needed = true;
    if (versions_[version].base >= 0) need(versions_[version].base);
    if (versions_[version].writer >= 0) run(versions_[version].writer);
    // Content kept from earlier frames must have been written in those.
    if (std::find(persistent_start_.begin(), persistent_start_.end(), version) != persistent_start_.end()) {
      need(final_[plan_.storages[versions_[version].storage].resource]);
    }
  }

  void run(int p) {
    if (plan_.passes[p].runs) return;
    plan_.passes[p].runs = true;
    const PassNode& pass = table_.passes[p];
    for (std::size_t s = 0; s < pass.connections.size(); ++s) {
      const Slot& slot = pass.offer->slots[s];
      if (pass.connections[s].resource < 0) continue;
      if (nodes_[p].slot_previous[s]) {
        need(final_[pass.connections[s].resource]);
      } else if (slot.access == SlotAccess::read) {
        need(nodes_[p].slot_version[s]);
      } else if (slot.access == SlotAccess::modify && !slot.optional) {
        need(versions_[nodes_[p].slot_version[s]].base);
      }
    }
  }

  std::string unread(int p) const {
    std::vector<std::string> names;
    const PassNode& pass = table_.passes[p];
    for (std::size_t s = 0; s < pass.connections.size(); ++s) {
      if (pass.connections[s].resource >= 0 && writes(pass.offer->slots[s].access)) {
        names.push_back(table_.resources[pass.connections[s].resource].name);
      }
    }
    return names.empty() ? "it writes nothing" : fmt::format("nobody reads {}", fmt::join(names, ", "));
  }

  void place_storages() {
    for (std::size_t p = 0; p < nodes_.size(); ++p) {
      if (!plan_.passes[p].runs) continue;
      const PassNode& pass = table_.passes[p];
      for (std::size_t s = 0; s < pass.connections.size(); ++s) {
        int storage = -1;
        if (nodes_[p].slot_previous[s]) {
          storage = previous_[pass.connections[s].resource];
        } else if (const int version = nodes_[p].slot_version[s]; version >= 0) {
          // An optional output that nobody reads is left out, so that the pass can save the work.
          const Slot& slot = pass.offer->slots[s];
          if (!writes(slot.access) || !slot.optional || versions_[version].needed) storage = versions_[version].storage;
        }
        plan_.passes[p].slot_storage[s] = storage;
        if (storage >= 0) touch(storage, static_cast<int>(p));
      }
    }
    for (const int shown : {plan_.output_storage, plan_.linear_output_storage}) {
      if (shown < 0) continue;
      Storage& output = plan_.storages[shown];
      if (output.first_pass < 0) output.first_pass = 0;  // shown as it was cleared
      output.last_pass = std::numeric_limits<int>::max();
    }
  }

  void touch(int storage, int pass) {
    Storage& s = plan_.storages[storage];
    if (s.first_pass < 0) s.first_pass = pass;
    s.last_pass = std::max(s.last_pass, pass);
  }

  void share_textures() {
    std::vector<bool> free;
    for (int p = 0; p < std::max(1, static_cast<int>(nodes_.size())); ++p) {
      for (Storage& storage : plan_.storages) {
        if (storage.kind != StorageKind::transient || storage.first_pass != p) continue;
        const TextureKey key = texture_key(table_.resources[storage.resource], width_, height_);
        for (std::size_t i = 0; i < free.size() && storage.physical < 0; ++i) {
          if (free[i] && plan_.physicals[i] == key) storage.physical = static_cast<int>(i);
        }
        if (storage.physical < 0) {
          storage.physical = static_cast<int>(plan_.physicals.size());
          plan_.physicals.push_back(key);
          free.push_back(false);
        }
        free[storage.physical] = false;
      }
      for (const Storage& storage : plan_.storages) {
        if (storage.physical >= 0 && storage.last_pass == p) free[storage.physical] = true;
      }
    }
  }

  const Table& table_;
  int width_, height_;
  Plan plan_;
  std::vector<Node> nodes_;
  std::vector<Version> versions_;
  std::vector<int> current_, final_;   // version of each resource: so far, at the end of the frame
  std::vector<int> previous_;          // storage of "previous:" of each resource
  std::vector<int> persistent_start_;  // versions
};

}  // namespace

TextureKey texture_key(const ResourceDesc& desc, int width, int height) {
  TextureKey key;
  // Rounded up, so that a half-size image still covers the odd last row.
  const auto scaled = [&](int size) { return std::max(1, static_cast<int>(std::ceil(size * desc.scale - 1e-6))); };
  key.width = desc.width ? desc.width : scaled(width);
  key.height = desc.height ? desc.height : scaled(height);
  const int full = full_mip_levels(key.width, key.height);
  key.levels = desc.mips == 0 ? full : std::min(desc.mips, full);
  key.layers = desc.layers;
  key.format = desc.format->format;
  return key;
}

Plan make_plan(const Table& table, const std::vector<bool>& wanted, int width, int height) {
  return Planner(table, wanted, width, height).take();
}

}  // namespace petrichor
