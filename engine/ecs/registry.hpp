#pragma once
// Entities and their components. References to components move on growth and removal; structural change
// while a view walks the same components is recorded in Commands (engine/ecs/commands.hpp) instead.

#include <cassert>
#include <cstdlib>
#include <utility>
#include <vector>

#include "engine/ecs/entity.hpp"
#include "engine/ecs/storage.hpp"
#include "engine/ecs/view.hpp"

namespace petrichor {

class Registry {
 public:
  Registry() = default;
  Registry(Registry&&) = default;
  Registry& operator=(Registry&&) = default;

  Entity create() {
    ++alive_;
    if (free_ != entity_index_mask) {
      const std::uint32_t index = free_;
      free_ = entity_index(slots_[index]);
      return slots_[index] = make_entity(index, entity_version(slots_[index]));
    }
    if (slots_.size() >= entity_index_mask) std::abort();  // four million entities: a leak
    slots_.push_back(make_entity(static_cast<std::uint32_t>(slots_.size()), 0));
    return slots_.back();
  }

  // Removes the entity and its components; it must be alive (asserts, else does nothing).
  void destroy(Entity e) {
    assert(alive(e));
    if (!alive(e)) return;
    for (std::size_t i = 0; i < storages_.all().size(); ++i) {  // a component's destructor may add a storage
      if (SparseSet* set = storages_.all()[i].get()) set->remove(e);
    }
    release(e);
  }

  bool alive(Entity e) const {
    const std::uint32_t index = entity_index(e);
    return index < slots_.size() && slots_[index] == e;
  }

  // Living entities.
  std::size_t size() const { return alive_; }
  // Entities that have a T.
  template <class T>
  std::size_t size() const {
    const Storage<T>* s = storages_.find<T>();
    return s ? s->size() : 0;
  }

  // Adds T{args...} to an entity that has none (asserts).
  template <class T, class... Args>
  T& emplace(Entity e, Args&&... args) {
    assert(alive(e));
    return storages_.assure<T>().emplace(e, std::forward<Args>(args)...);
  }

  template <class T, class... Args>
  T& emplace_or_replace(Entity e, Args&&... args) {
    if (T* value = find<T>(e)) {
      if constexpr (std::is_constructible_v<T, Args...>)
        *value = T(std::forward<Args>(args)...);
      else
        *value = T{std::forward<Args>(args)...};
      return *value;
    }
    return emplace<T>(e, std::forward<Args>(args)...);
  }

  // False where there was none.
  template <class T>
  bool remove(Entity e) {
    Storage<T>* s = storages_.find<T>();
    return s && s->remove(e);
  }

  // nullptr where the entity is dead or has no T.
  template <class T>
  T* find(Entity e) {
    Storage<T>* s = storages_.find<T>();
    return s ? s->find(e) : nullptr;
  }
  template <class T>
  const T* find(Entity e) const {
    return const_cast<Registry*>(this)->find<T>(e);
  }

  template <class T>
  T& get(Entity e) {
    T* value = find<T>(e);
    assert(value);
    return *value;
  }
  template <class T>
  const T& get(Entity e) const {
    return const_cast<Registry*>(this)->get<T>(e);
  }

  template <class... T>
  bool has(Entity e) const {
    return (find<T>(e) && ...);
  }

  // Destroys all entities; handles to them stay dead.
  void clear() {
    for (std::size_t i = 0; i < storages_.all().size(); ++i) {
      if (SparseSet* set = storages_.all()[i].get()) set->clear();
    }
    for (std::size_t index = slots_.size(); index-- > 0;) {
      if (entity_index(slots_[index]) == index) release(slots_[index]);
    }
  }
  template <class T>
  void clear() {
    if (Storage<T>* s = storages_.find<T>()) s->clear();
  }

  template <class T>
  void reserve(std::size_t count) {
    storages_.assure<T>().reserve(count);
  }
  void reserve(std::size_t count) { slots_.reserve(count); }

  // Walks entities with all of T: see View::each. A const registry gives const components.
  template <class... T>
  View<TypeList<T...>, TypeList<>> view() {
    return View<TypeList<T...>, TypeList<>>(storages_);
  }
  template <class... T>
  View<TypeList<const T...>, TypeList<>> view() const {
    return View<TypeList<const T...>, TypeList<>>(storages_);
  }

  // fn(Entity) for every living entity, by index.
  template <class Fn>
  void each(Fn&& fn) const {
    for (std::size_t index = 0; index < slots_.size(); ++index) {
      if (const Entity e = slots_[index]; entity_index(e) == index) fn(e);
    }
  }

  // Sets the order in which views led by T walk: less(const T&, const T&) or less(Entity, Entity); stable.
  template <class T, class Less>
  void sort(Less less) {
    if (Storage<T>* s = storages_.find<T>()) s->sort(std::move(less));
  }
  // Orders T as From is; entities without From come last and keep their order.
  template <class T, class From>
  void sort_as() {
    Storage<T>* to = storages_.find<T>();
    const Storage<From>* from = storages_.find<From>();
    if (to && from) to->sort_as(*from);
  }

 private:
  // A free slot holds the next version and, in place of its own index, the next free index: it equals
  // no handle. The last version is never reissued (and with the mask's index it is the null entity).
  void release(Entity e) {
    const std::uint32_t index = entity_index(e);
    --alive_;
    if (entity_version(e) == entity_version_mask) {
      slots_[index] = null_entity;
      return;
    }
    slots_[index] = make_entity(free_, entity_version(e) + 1);
    free_ = index;
  }

  std::vector<Entity> slots_;
  std::uint32_t free_ = entity_index_mask;  // head of the list of free slots
  std::size_t alive_ = 0;
  Storages storages_;
};

}  // namespace petrichor
