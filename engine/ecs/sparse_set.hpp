#pragma once
// A set of entities as two arrays: `dense` lists them contiguously, `sparse` says where each index sits.
// The sparse array is not paged: membership of an entity known to be alive is one read.

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/ecs/entity.hpp"

namespace petrichor {

class SparseSet {
 public:
  static constexpr std::uint32_t absent = 0xffffffffu;

  SparseSet() = default;
  SparseSet(const SparseSet&) = delete;
  SparseSet& operator=(const SparseSet&) = delete;
  virtual ~SparseSet() = default;

  std::size_t size() const { return dense_.size(); }
  bool empty() const { return dense_.empty(); }
  std::span<const Entity> entities() const { return dense_; }
  std::span<const std::uint32_t> sparse() const { return sparse_; }

  // Position in entities(), or `absent`. The version counts: a stale handle is absent.
  std::uint32_t position(Entity e) const {
    const std::uint32_t index = entity_index(e);
    const std::uint32_t at = index < sparse_.size() ? sparse_[index] : absent;
    return at != absent && dense_[at] == e ? at : absent;
  }
  bool contains(Entity e) const { return position(e) != absent; }

  // Adds an entity that is not in the set (asserts). For plain sets; a Storage emplaces instead.
  void push(Entity e) {
    assert_unlocked();
    reserve_one(e);
    link(e);
  }

  // Fills the hole with the last entity. False where there was nothing to remove.
  bool remove(Entity e) {
    const std::uint32_t at = position(e);
    if (at == absent) return false;
    assert_unlocked();
    erase_at(at);
    return true;
  }

  virtual void clear() {
    assert_unlocked();
    unlink_all();
  }

  virtual void reserve(std::size_t count) { dense_.reserve(count); }

  // order[i] is the present position of what shall stand at i; a permutation of 0..size-1.
  virtual void permute(std::span<const std::uint32_t> order) {
    assert_unlocked();
    relink(order);
  }

  // less(Entity, Entity). Stable, so equal elements keep their order on every machine.
  template <class Less>
  void sort_entities(Less less) {
    std::vector<std::uint32_t> order = identity();
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return less(dense_[a], dense_[b]); });
    permute(order);
  }

  // Entities that `other` has too come first, in its order; the rest keep theirs.
  void sort_as(const SparseSet& other) {
    std::vector<std::uint32_t> order;
    order.reserve(size());
    for (const Entity e : other.dense_) {
      if (const std::uint32_t at = position(e); at != absent) order.push_back(at);
    }
    if (order.size() < size()) {
      std::vector<bool> placed(size(), false);
      for (const std::uint32_t at : order) placed[at] = true;
      for (std::uint32_t at = 0; at < size(); ++at) {
        if (!placed[at]) order.push_back(at);
      }
    }
    permute(order);
  }

  // A view holds the lock while it walks; structural change then is a programmer error.
  void lock() const { ++locks_; }
  void unlock() const { --locks_; }

 protected:
  void assert_unlocked() const {
    assert(locks_ == 0 && "structural change while a view walks this component: record it in Commands");
  }

  std::vector<std::uint32_t> identity() const {
    std::vector<std::uint32_t> order(size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    return order;
  }

  // All that may throw when an entity is added, so that link() cannot.
  void reserve_one(Entity e) {
    assert(e != null_entity && !contains(e));
    const std::uint32_t index = entity_index(e);
    if (index >= sparse_.size()) sparse_.resize(std::bit_ceil(std::size_t{index} + 1), absent);
    if (dense_.size() == dense_.capacity()) dense_.reserve(std::max<std::size_t>(16, 2 * dense_.capacity()));
  }

  void link(Entity e) {
    sparse_[entity_index(e)] = static_cast<std::uint32_t>(dense_.size());
    dense_.push_back(e);
  }

  void unlink(std::uint32_t at) {
    const Entity last = dense_.back();
    const Entity gone = dense_[at];
    dense_[at] = last;
    sparse_[entity_index(last)] = at;
    sparse_[entity_index(gone)] = absent;  // after: `last` and `gone` may be one
    dense_.pop_back();
  }

  void unlink_all() {
    for (const Entity e : dense_) sparse_[entity_index(e)] = absent;
    dense_.clear();
  }

  void relink(std::span<const std::uint32_t> order) {
    assert(order.size() == dense_.size());
    std::vector<Entity> dense(dense_.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      dense[i] = dense_[order[i]];
      sparse_[entity_index(dense[i])] = i;
    }
    dense_.swap(dense);
  }

  virtual void erase_at(std::uint32_t at) { unlink(at); }

 private:
  std::vector<std::uint32_t> sparse_;
  std::vector<Entity> dense_;
  mutable int locks_ = 0;
};

}  // namespace petrichor
