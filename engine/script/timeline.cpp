#include "engine/script/timeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <lua.hpp>
#include <nlohmann/json.hpp>

#include "engine/script/values.hpp"

namespace petrichor::script {

struct Timeline::Event {
  std::string name;
  nlohmann::json argument;
};

Timeline::Timeline(Sandbox& sandbox) : sandbox_(sandbox) {
  sandbox_.is_timeline_thread = [this](lua_State* thread) { return owns(thread); };
}

Timeline::~Timeline() = default;

bool Timeline::owns(lua_State* thread) const {
  return std::any_of(tasks_.begin(), tasks_.end(), [&](const auto& t) { return t.second.thread == thread; });
}

Timeline::Task* Timeline::current_task() {
  const auto found = tasks_.find(current_);
  return found == tasks_.end() ? nullptr : &found->second;
}

std::uint64_t Timeline::start(lua_State* state, int arguments) {
  charge(state, 200);
  lua_State* thread = lua_newthread(state);
  luaL_checkstack(thread, arguments + 1, "too many arguments");
  const int reference = luaL_ref(state, LUA_REGISTRYINDEX);
  lua_xmove(state, thread, arguments + 1);
  const std::uint64_t id = next_id_++;
  tasks_[id] = Task{thread, reference, arguments, false, {}};
  due_.insert({now_s_, id});
  return id;
}

Result<void> Timeline::run_now(std::uint64_t task) {
  due_.erase({now_s_, task});
  errors_.clear();
  resume(task);
  if (errors_.empty()) return {};
  return failure(std::move(errors_.front()));
}

void Timeline::resume(std::uint64_t id) {
  const auto found = tasks_.find(id);
  if (found == tasks_.end()) return;
  lua_State* thread = found->second.thread;
  const int arguments = std::exchange(found->second.arguments, 0);
  found->second.waits = false;
  current_ = id;
  current_thread_ = thread;
  int results = 0;
  const int status = lua_resume(thread, sandbox_.state, arguments, &results);
  current_ = 0;
  current_thread_ = nullptr;
  if (status == LUA_YIELD) {
    lua_pop(thread, results);
    if (found->second.waits) return;
    errors_.push_back("coroutine.yield() was called outside a coroutine of the script's own; use wait() in a timeline");
  } else if (status != LUA_OK) {
    errors_.push_back(sandbox_.failure_text(thread, status));
  }
  luaL_unref(sandbox_.state, LUA_REGISTRYINDEX, found->second.reference);
  tasks_.erase(id);
  std::erase_if(tracks_, [&](const Track& t) { return t.task == id; });
}

void Timeline::apply_tracks(double time_s) {
  for (Track& track : tracks_) {
    const auto applied = track.apply(std::clamp(time_s, track.start_s, track.end_s), track.targets);
    if (applied) continue;
    // The one who waits for it hears of it, at its own line.
    const auto task = tasks_.find(track.task);
    if (task == tasks_.end()) continue;
    task->second.error = applied.error().message;
    due_.erase({track.end_s, track.task});
    due_.insert({now_s_, track.task});
    track.end_s = -1.0;
  }
  std::erase_if(tracks_, [&](const Track& t) { return t.end_s <= time_s; });
}

Result<void> Timeline::advance(double time_s) {
  if (!std::isfinite(time_s) || time_s < now_s_) {
    return failure(fmt::format("the timeline stands at {} s and cannot go to {} s", now_s_, time_s));
  }
  errors_.clear();
  for (const std::uint64_t id : next_step_) due_.insert({time_s, id});
  next_step_.clear();
  bool pending = !pending_.empty();
  while (!sandbox_.killed) {
    // Events from outside come at this step's time: after all that was due before it.
    if (pending && (due_.empty() || due_.begin()->first >= time_s)) {
      pending = false;
      apply_tracks(now_s_ = time_s);
      dispatch_pending();
      continue;
    }
    if (due_.empty() || due_.begin()->first > time_s) {
      // A track that fails here wakes its task at once.
      apply_tracks(now_s_ = time_s);
      if (due_.empty() || due_.begin()->first > time_s) break;
    }
    const auto [wake_s, id] = *due_.begin();
    due_.erase(due_.begin());
    now_s_ = std::max(now_s_, wake_s);
    apply_tracks(now_s_);
    resume(id);
  }
  if (sandbox_.killed) apply_tracks(now_s_ = time_s);
  if (errors_.empty()) return {};
  std::string all;
  for (std::size_t i = 0; i < std::min<std::size_t>(errors_.size(), 5); ++i) all += (i ? "\n" : "") + errors_[i];
  if (errors_.size() > 5) all += fmt::format("\nand {} more errors in this step", errors_.size() - 5);
  return failure(std::move(all));
}

// ---- what a running task can wait for ---------------------------------------------------------------------

int Timeline::continued(lua_State* state, int, std::intptr_t context) {
  auto& self = *reinterpret_cast<Timeline*>(context);
  if (Task* task = self.current_task(); task && !task->error.empty()) {
    const std::string error = std::exchange(task->error, {});
    raise(state, error);
  }
  return lua_gettop(state);  // what an event brought
}

int Timeline::yield(lua_State* state) {
  current_task()->waits = true;
  lua_settop(state, 0);
  return lua_yieldk(state, 0, reinterpret_cast<lua_KContext>(this), continued);
}

int Timeline::wait_until(lua_State* state, double time_s) {
  due_.insert({time_s, current_});
  return yield(state);
}

int Timeline::wait_next_step(lua_State* state) {
  next_step_.push_back(current_);
  return yield(state);
}

int Timeline::wait_for_event(lua_State* state, const std::string& event) {
  listeners_.emplace_back(event, current_);
  return yield(state);
}

int Timeline::run_track(lua_State* state, Track track) {
  for (Track& other : tracks_) {
    std::erase_if(other.targets, [&](const Target& t) {
      return std::find(track.targets.begin(), track.targets.end(), t) != track.targets.end();
    });
    // Its task still waits for its end, but what it would have written need not be kept.
    if (other.targets.empty()) other.apply = [](double, const std::vector<Target>&) -> Result<void> { return {}; };
  }
  track.task = current_;
  track.start_s = now_s_;
  const double end_s = track.end_s;
  tracks_.push_back(std::move(track));
  return wait_until(state, end_s);
}

// ---- events -----------------------------------------------------------------------------------------------

std::uint64_t Timeline::add_handler(lua_State* state, const std::string& event) {
  const std::uint64_t id = next_id_++;
  handlers_.push_back(Handler{id, event, luaL_ref(state, LUA_REGISTRYINDEX)});
  return id;
}

void Timeline::remove_handler(lua_State* state, std::uint64_t id) {
  const auto found = std::find_if(handlers_.begin(), handlers_.end(), [&](const Handler& h) { return h.id == id; });
  if (found == handlers_.end()) return;
  luaL_unref(state, LUA_REGISTRYINDEX, found->reference);
  handlers_.erase(found);
}

int Timeline::emit(lua_State* state, const std::string& event, int arguments) {
  const int first = lua_gettop(state) - arguments + 1;
  luaL_checkstack(state, arguments + 2, "too many arguments");
  int count = 0;
  for (std::size_t i = 0, n = handlers_.size(); i < n; ++i) {
    if (handlers_[i].event != event) continue;
    lua_rawgeti(state, LUA_REGISTRYINDEX, handlers_[i].reference);
    for (int a = 0; a < arguments; ++a) lua_pushvalue(state, first + a);
    start(state, arguments);
    ++count;
  }
  for (std::size_t i = 0; i < listeners_.size();) {
    if (listeners_[i].first != event) {
      ++i;
      continue;
    }
    const std::uint64_t id = listeners_[i].second;
    listeners_.erase(listeners_.begin() + static_cast<std::ptrdiff_t>(i));
    const auto task = tasks_.find(id);
    if (task == tasks_.end()) continue;
    luaL_checkstack(task->second.thread, arguments, "too many arguments");
    for (int a = 0; a < arguments; ++a) lua_pushvalue(state, first + a);
    lua_xmove(state, task->second.thread, arguments);
    task->second.arguments = arguments;
    due_.insert({now_s_, id});
    ++count;
  }
  lua_settop(state, first - 1);
  return count;
}

void Timeline::emit_later(std::string event, const nlohmann::json& argument) {
  pending_.push_back(Event{std::move(event), argument});
}

void Timeline::dispatch_pending() {
  const std::vector<Event> events = std::exchange(pending_, {});
  const auto sent = sandbox_.protect([&](lua_State* state) {
    for (const Event& event : events) {
      if (!event.argument.is_null()) push_json(state, event.argument);
      emit(state, event.name, event.argument.is_null() ? 0 : 1);
    }
  });
  if (!sent) errors_.push_back(sent.error().message);
}

}  // namespace petrichor::script
