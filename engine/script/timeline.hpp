#pragma once
// Inside engine/script: coroutines in simulation time. A task asks to be woken at a time and is resumed with
// the clock at exactly that time, so waits add up without drift and steps of any size give the same story.
// Tracks (tweens, paths) are values as closed forms of time; nothing is accumulated.

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/ecs/schema.hpp"
#include "engine/script/sandbox.hpp"

namespace petrichor::script {

// A field of an entity that a track writes; a later track on the same field takes it over.
struct Target {
  Entity entity;
  const Field* field = nullptr;
  friend bool operator==(const Target&, const Target&) = default;
};

struct Track {
  std::uint64_t task = 0;  // who waits for it
  double start_s = 0;
  double end_s = 0;
  std::vector<Target> targets;
  std::function<Result<void>(double time_s, const std::vector<Target>& targets)> apply;
};

class Timeline {
 public:
  explicit Timeline(Sandbox&);
  ~Timeline();

  double now_s() const { return now_s_; }
  bool busy() const { return !tasks_.empty() || !tracks_.empty(); }
  bool is_current(lua_State* thread) const { return current_ && current_thread_ == thread; }
  bool owns(lua_State* thread) const;

  // Takes a function with `arguments` arguments from the stack top into a task that is due now. Inside a C function.
  std::uint64_t start(lua_State*, int arguments);
  // As start, and runs it at once: the main chunk. Without protection around it.
  Result<void> run_now(std::uint64_t task);
  Result<void> advance(double time_s);

  // For bindings, of the task that runs now, which must be able to yield. Each ends with lua_yieldk, so the
  // caller returns its value.
  int wait_until(lua_State*, double time_s);
  int wait_next_step(lua_State*);
  int wait_for_event(lua_State*, const std::string& event);
  int run_track(lua_State*, Track);

  std::uint64_t add_handler(lua_State*, const std::string& event);  // the function on the stack top
  std::size_t handlers() const { return handlers_.size(); }
  void remove_handler(lua_State*, std::uint64_t handler);
  // Wakes who listens, with the `arguments` values on the stack top; pops them. Returns how many listen.
  int emit(lua_State*, const std::string& event, int arguments);
  void emit_later(std::string event, const nlohmann::json& argument);

 private:
  struct Task {
    lua_State* thread = nullptr;
    int reference = 0;   // holds the thread in Lua's registry
    int arguments = 0;   // on the thread's stack, for the next resume
    bool waits = false;  // suspended by one of the waits, not by a yield of the script's
    std::string error;   // raised inside the task when it goes on
  };
  struct Handler {
    std::uint64_t id = 0;
    std::string event;
    int reference = 0;
  };
  struct Event;

  Task* current_task();
  int yield(lua_State*);
  void resume(std::uint64_t id);
  void apply_tracks(double time_s);
  void dispatch_pending();
  static int continued(lua_State*, int status, std::intptr_t context);

  Sandbox& sandbox_;
  std::map<std::uint64_t, Task> tasks_;  // by creation order
  std::set<std::pair<double, std::uint64_t>> due_;
  std::vector<std::uint64_t> next_step_;
  std::vector<std::pair<std::string, std::uint64_t>> listeners_;  // wait_for
  std::vector<Handler> handlers_;
  std::vector<Track> tracks_;  // by creation order
  std::vector<Event> pending_;
  std::vector<std::string> errors_;
  std::uint64_t next_id_ = 1;
  std::uint64_t current_ = 0;
  lua_State* current_thread_ = nullptr;
  double now_s_ = 0;
};

}  // namespace petrichor::script
