#pragma once
// One frame's plan, made from a checked table and from what the frame asks for: which passes run, and which texture
// stands in which slot. Pure data; no OpenGL here.
//
// A pass that does not run is as if it were not in the table. Each `write` starts a new version of a resource, with a
// texture of its own; `modify` goes on with the version it finds. So a pass may read and write the same name.

#include <string>
#include <vector>

#include "engine/graph/table.hpp"

namespace petrichor {

struct TextureKey {
  int width = 0, height = 0, levels = 1;
  int layers = 0;     // 0: 2D
  GLenum format = 0;  // GL_NONE: no texture at all, only the order of passes
  friend bool operator==(const TextureKey&, const TextureKey&) = default;
};

enum class StorageKind { transient, history_now, history_previous, persistent };

// One texture as the passes see it.
struct Storage {
  int resource = -1;
  StorageKind kind = StorageKind::transient;
  int first_pass = -1, last_pass = -1;  // that touch it; -1: none does
  bool clear_first = false;
  int physical = -1;  // transient only: index into Plan::physicals
};

struct PassPlan {
  bool runs = false;
  std::string reason;             // why not
  std::vector<int> slot_storage;  // index into Plan::storages; -1: has() is false
};

struct Plan {
  std::vector<PassPlan> passes;  // as in the table
  std::vector<Storage> storages;
  std::vector<TextureKey> physicals;  // transient textures, each shared by storages with disjoint lifetimes
  int output_storage = -1;
  int linear_output_storage = -1;  // -1: none, or nothing that runs writes it
  std::string error;               // why there is no picture; empty where there is one
};

TextureKey texture_key(const ResourceDesc&, int width, int height);
// wanted: one a pass. width, height: of the output, pixels.
Plan make_plan(const Table&, const std::vector<bool>& wanted, int width, int height);

}  // namespace petrichor
