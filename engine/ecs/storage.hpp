#pragma once
// The values of one component type, contiguous and in the order of the set's entities. References move
// when the storage grows, sorts or removes: keep an Entity, not a T&.

#include <memory>
#include <type_traits>
#include <utility>

#include "engine/ecs/sparse_set.hpp"

namespace petrichor {

template <class T>
class Storage final : public SparseSet {
  static_assert(std::is_same_v<T, std::remove_cvref_t<T>>, "a component is a plain type");
  static_assert(!std::is_same_v<T, bool>, "give the component a name: struct Wet {}");
  static_assert(std::is_move_constructible_v<T> && std::is_move_assignable_v<T>, "a component must be movable");

 public:
  // A type without data keeps one shared instance and no array.
  static constexpr bool is_tag = std::is_empty_v<T>;

  // Initialises T from the arguments, aggregates included; the entity must not have one (asserts).
  // Whatever throws leaves the storage as it was.
  template <class... Args>
  T& emplace(Entity e, Args&&... args) {
    assert_unlocked();
    T value = make(std::forward<Args>(args)...);  // first: a constructor may itself use this storage
    reserve_one(e);
    if constexpr (is_tag) {
      (void)value;
      link(e);
      return tag_;
    } else {
      values_.push_back(std::move(value));
      link(e);
      return values_.back();
    }
  }

  // Only for positions below size().
  T& at(std::uint32_t position) { return element(data(), position); }
  const T& at(std::uint32_t position) const { return element(data(), position); }

  T* find(Entity e) {
    const std::uint32_t where = position(e);
    return where == absent ? nullptr : &at(where);
  }
  const T* find(Entity e) const { return const_cast<Storage*>(this)->find(e); }

  T* data() {
    if constexpr (is_tag)
      return &tag_;
    else
      return values_.data();
  }
  const T* data() const { return const_cast<Storage*>(this)->data(); }

  template <class U>  // T or const T
  static U& element(U* data, std::uint32_t position) {
    if constexpr (is_tag)
      return *data;
    else
      return data[position];
  }

  // less(const T&, const T&) or less(Entity, Entity); stable.
  template <class Less>
  void sort(Less less) {
    if constexpr (std::is_invocable_v<Less&, const T&, const T&>) {
      std::vector<std::uint32_t> order = identity();
      std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return less(std::as_const(*this).at(a), std::as_const(*this).at(b));
      });
      permute(order);
    } else {
      sort_entities(less);
    }
  }

  void clear() override {
    assert_unlocked();
    unlink_all();
    if constexpr (std::is_trivially_destructible_v<T>) {
      values_.clear();
    } else {
      std::vector<T> gone;  // a destructor may use this storage, which is empty and whole by then
      gone.swap(values_);
    }
  }

  void reserve(std::size_t count) override {
    SparseSet::reserve(count);
    if constexpr (!is_tag) values_.reserve(count);
  }

  void permute(std::span<const std::uint32_t> order) override {
    assert_unlocked();
    if constexpr (!is_tag) {
      std::vector<T> values;
      values.reserve(values_.capacity());
      for (const std::uint32_t from : order) values.push_back(std::move(values_[from]));
      values_.swap(values);
    }
    relink(order);
  }

 protected:
  void erase_at(std::uint32_t at) override {
    if constexpr (is_tag) {
      unlink(at);
    } else {
      const bool is_last = at + 1 == values_.size();  // self-move is not for every type
      if constexpr (std::is_trivially_destructible_v<T>) {
        if (!is_last) values_[at] = std::move(values_.back());
        values_.pop_back();
        unlink(at);
      } else {
        const T gone = std::move(values_[at]);  // destroyed last: its destructor may use this storage
        if (!is_last) values_[at] = std::move(values_.back());
        values_.pop_back();
        unlink(at);
      }
    }
  }

 private:
  template <class... Args>
  static T make(Args&&... args) {
    if constexpr (std::is_constructible_v<T, Args...>)
      return T(std::forward<Args>(args)...);
    else
      return T{std::forward<Args>(args)...};
  }

  struct Nothing {};
  std::vector<T> values_;
  [[no_unique_address]] std::conditional_t<is_tag, T, Nothing> tag_{};
};

// One storage per component type, found by a small number given to each type on first use.
class Storages {
 public:
  template <class T>
  Storage<T>* find() const {
    const std::size_t id = type_id<T>();
    return id < sets_.size() ? static_cast<Storage<T>*>(sets_[id].get()) : nullptr;
  }

  template <class T>
  Storage<T>& assure() {
    if (Storage<T>* known = find<T>()) return *known;
    const std::size_t id = type_id<T>();
    if (id >= sets_.size()) sets_.resize(id + 1);
    sets_[id] = std::make_unique<Storage<T>>();
    return static_cast<Storage<T>&>(*sets_[id]);
  }

  std::span<const std::unique_ptr<SparseSet>> all() const { return sets_; }

  template <class T>
  static std::size_t type_id() {
    static const std::size_t id = next_type_id()++;
    return id;
  }

 private:
  static std::size_t& next_type_id() {
    static std::size_t next = 0;
    return next;
  }
  std::vector<std::unique_ptr<SparseSet>> sets_;  // null where this registry never saw the type
};

}  // namespace petrichor
