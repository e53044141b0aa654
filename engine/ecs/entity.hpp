#pragma once
#include <cstdint>

namespace petrichor {

// Index and version packed in one word: a handle to a destroyed entity is told from its successor.
struct Entity {
  std::uint32_t bits = 0xffffffffu;  // the null entity
  friend bool operator==(Entity, Entity) = default;
};

inline constexpr Entity null_entity{};

// The low bits hold the index (4,194,302 entities at once), the high bits count the index's reuses. An
// index whose versions run out is retired, so no handle is ever mistaken for a later entity.
inline constexpr std::uint32_t entity_index_bits = 22;
inline constexpr std::uint32_t entity_index_mask = (1u << entity_index_bits) - 1u;  // the null entity's index
inline constexpr std::uint32_t entity_version_mask = 0xffffffffu >> entity_index_bits;

constexpr std::uint32_t entity_index(Entity e) {
  return e.bits & entity_index_mask;
}
constexpr std::uint32_t entity_version(Entity e) {
  return e.bits >> entity_index_bits;
}
constexpr Entity make_entity(std::uint32_t index, std::uint32_t version) {
  return Entity{(version << entity_index_bits) | (index & entity_index_mask)};
}

}  // namespace petrichor
