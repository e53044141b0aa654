#pragma once
// Walks the entities that have all of some components: registry.view<A, const B>().without<C>().each(fn).

#include <array>
#include <tuple>
#include <type_traits>
#include <utility>

#include "engine/ecs/storage.hpp"

namespace petrichor {

template <class... T>
struct TypeList {};

template <class Included, class Excluded>
class View;

template <class... A, class... C>
class View<TypeList<A...>, TypeList<C...>> {
  static_assert(sizeof...(A) > 0, "a view needs a component to walk");
  static constexpr std::size_t count = sizeof...(A);
  using Indices = std::index_sequence_for<A...>;

 public:
  explicit View(const Storages& storages)
      : storages_(&storages),
        included_{storages.find<std::remove_const_t<A>>()...},
        excluded_{storages.find<std::remove_const_t<C>>()...} {}

  // The same walk, less the entities that have any of D.
  template <class... D>
  View<TypeList<A...>, TypeList<C..., D...>> without() const {
    return View<TypeList<A...>, TypeList<C..., D...>>(*storages_);
  }

  // fn(Entity, A&...) or fn(A&...), in the order of the smallest storage. A type without data is passed
  // too. Adding or removing any of the view's components inside is a programmer error (asserts).
  template <class Fn>
  void each(Fn&& fn) const {
    each_while([&](Entity e, A&... values) {
      if constexpr (std::is_invocable_v<Fn&, Entity, A&...>)
        fn(e, values...);
      else
        fn(values...);
      return true;
    });
  }

  // The first entity of the walk, or the null entity.
  Entity front() const {
    Entity found = null_entity;
    each_while([&](Entity e, A&...) {
      found = e;
      return false;
    });
    return found;
  }
  bool empty() const { return front() == null_entity; }

  // How many entities each() meets; a walk, save for one component.
  std::size_t size() const {
    if constexpr (count == 1 && sizeof...(C) == 0) {
      return std::get<0>(included_) ? std::get<0>(included_)->size() : 0;
    } else {
      std::size_t met = 0;
      each([&](A&...) { ++met; });
      return met;
    }
  }

 private:
  // What the loop needs of one storage, out of reach of the stores that fn makes.
  template <class T>
  struct Column {
    T* values;
    const std::uint32_t* sparse;
    std::size_t sparse_size;
    std::uint32_t position(std::uint32_t index) const {
      return index < sparse_size ? sparse[index] : SparseSet::absent;
    }
  };

  struct Lock {
    const View& view;
    explicit Lock(const View& v) : view(v) {
      view.for_each_set([](const SparseSet& s) { s.lock(); });
    }
    ~Lock() {
      view.for_each_set([](const SparseSet& s) { s.unlock(); });
    }
  };

  template <class Fn>
  void for_each_set(Fn fn) const {
    std::apply([&](const auto*... s) { (fn(*s), ...); }, included_);
    for (const SparseSet* s : excluded_) {
      if (s) fn(*s);
    }
  }

  template <class Fn>  // fn returns false to stop
  void each_while(Fn&& fn) const {
    if (std::apply([](const auto*... s) { return (!s || ...); }, included_)) return;
    const std::array<std::size_t, count> sizes =
        std::apply([](const auto*... s) { return std::array<std::size_t, count>{s->size()...}; }, included_);
    const auto lead = static_cast<std::size_t>(std::min_element(sizes.begin(), sizes.end()) - sizes.begin());
#ifndef NDEBUG
    const Lock lock(*this);
#endif
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      ((lead == I && (walk<I>(fn, Indices{}), true)) || ...);
    }
    (Indices{});
  }

  // The leading storage proves that its entities are alive, so the other storages are asked by index
  // alone: one read each, no version to compare.
  template <std::size_t Lead, class Fn, std::size_t... I>
  void walk(Fn& fn, std::index_sequence<I...>) const {
    const std::span<const Entity> entities = std::get<Lead>(included_)->entities();
    const Entity* const first = entities.data();
    const std::size_t size = entities.size();
    const std::tuple<Column<A>...> columns{Column<A>{std::get<I>(included_)->data(),
                                                     std::get<I>(included_)->sparse().data(),
                                                     std::get<I>(included_)->sparse().size()}...};
    for (std::uint32_t at = 0; at < size; ++at) {
      const Entity e = first[at];
      const std::uint32_t index = entity_index(e);
      std::array<std::uint32_t, count> position;
      position[Lead] = at;
      if (!((I == Lead || (position[I] = std::get<I>(columns).position(index)) != SparseSet::absent) && ...)) continue;
      if (is_excluded(index)) continue;
      if (!fn(e, Storage<std::remove_const_t<A>>::element(std::get<I>(columns).values, position[I])...)) return;
    }
  }

  bool is_excluded(std::uint32_t index) const {
    if constexpr (sizeof...(C) > 0) {
      for (const SparseSet* s : excluded_) {
        if (s && index < s->sparse().size() && s->sparse()[index] != SparseSet::absent) return true;
      }
    }
    return false;
  }

  const Storages* storages_;
  std::tuple<Storage<std::remove_const_t<A>>*...> included_;
  std::array<const SparseSet*, sizeof...(C)> excluded_;
};

}  // namespace petrichor
