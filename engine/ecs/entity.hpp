#pragma once
#include <cstdint>

namespace petrichor {

// Index and version packed in one word: a handle to a destroyed entity is told from its successor.
struct Entity {
  std::uint32_t bits = 0xffffffffu;  // the null entity
  friend bool operator==(Entity, Entity) = default;
};

inline constexpr Entity null_entity{};

}  // namespace petrichor
