#pragma once
// Structural change recorded while views walk, and applied in order at a sync point.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "engine/ecs/registry.hpp"

namespace petrichor {

class Commands {
 public:
  explicit Commands(Registry& registry) : registry_(&registry) {}
  Commands(Commands&&) = default;
  Commands& operator=(Commands&&) = default;

  // The entity lives at once, bare, so that later commands can name it; no view can meet it before apply().
  Entity create() { return registry_->create(); }

  // At apply() a dead entity is passed over: two systems may well destroy the same one.
  void destroy(Entity e) {
    steps_.push_back({e, 0, [](Commands& c, Entity entity, std::size_t) {
                        if (c.registry_->alive(entity)) c.registry_->destroy(entity);
                      }});
  }

  // Adds or replaces T{args...}; passed over if the entity is dead by then.
  template <class T, class... Args>
  void emplace(Entity e, Args&&... args) {
    std::vector<T>& values = queue<T>().values;
    if constexpr (std::is_constructible_v<T, Args...>)
      values.push_back(T(std::forward<Args>(args)...));
    else
      values.push_back(T{std::forward<Args>(args)...});
    steps_.push_back({e, values.size() - 1, [](Commands& c, Entity entity, std::size_t at) {
                        if (!c.registry_->alive(entity)) return;
                        T value = std::move(c.queue<T>().values[at]);
                        c.registry_->emplace_or_replace<T>(entity, std::move(value));
                      }});
  }

  template <class T>
  void remove(Entity e) {
    steps_.push_back({e, 0, [](Commands& c, Entity entity, std::size_t) { c.registry_->remove<T>(entity); }});
  }

  bool empty() const { return steps_.empty(); }

  // Does everything in the order it was recorded. What a component's constructor or destructor records
  // meanwhile is done in the same call, last.
  void apply() {
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const Step step = steps_[i];
      step.run(*this, step.entity, step.at);
    }
    steps_.clear();
    for (const auto& q : queues_) {
      if (q) q->clear();
    }
  }

 private:
  struct Step {
    Entity entity;
    std::size_t at;  // place of the value in its type's queue
    void (*run)(Commands&, Entity, std::size_t at);
  };
  // One queue per component type: recording costs no allocation of its own.
  struct Queue {
    virtual ~Queue() = default;
    virtual void clear() = 0;
  };
  template <class T>
  struct QueueOf final : Queue {
    std::vector<T> values;
    void clear() override { values.clear(); }
  };

  template <class T>
  QueueOf<T>& queue() {
    const std::size_t id = Storages::type_id<T>();
    if (id >= queues_.size()) queues_.resize(id + 1);
    if (!queues_[id]) queues_[id] = std::make_unique<QueueOf<T>>();
    return static_cast<QueueOf<T>&>(*queues_[id]);
  }

  Registry* registry_;
  std::vector<Step> steps_;
  std::vector<std::unique_ptr<Queue>> queues_;
};

}  // namespace petrichor
