#pragma once
// Inside engine/script: one Lua state whose scripts can reach nothing but what they are given, and which is
// stopped when it uses too much. Linked to Lua compiled as C++, so that lua_error unwinds destructors.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/script/script.hpp"

struct lua_State;

namespace petrichor::script {

using LuaFunction = int (*)(lua_State*);

struct Sandbox {
  explicit Sandbox(const ScriptOptions&);
  ~Sandbox();
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;

  // Before each call from outside: a fresh budget.
  void begin(std::uint64_t instructions);

  // Runs `body` with the main state under protection; it may use any of the Lua API.
  Result<void> protect(const std::function<void(lua_State*)>& body);

  // Reads and compiles a text chunk and pushes it; only inside protect or a C function.
  Result<void> load(lua_State*, const std::filesystem::path&);

  // The message of a thread whose lua_resume failed with `status`, with its traceback.
  std::string failure_text(lua_State* thread, int status);

  lua_State* state = nullptr;
  ScriptLimits limits;
  std::vector<std::filesystem::path> roots;
  std::function<void(std::string_view)> print;
  std::vector<std::filesystem::path> files;
  std::uint64_t seed = 1;
  std::uint64_t random_index = 0;

  std::uint64_t budget = 0;
  std::uint64_t spent = 0;
  std::size_t memory_used = 0;
  std::size_t memory_spare = 0;  // granted while an error is being told
  std::chrono::steady_clock::time_point started;
  int closing = 0;      // coroutines being closed inside one another
  bool killed = false;  // no code of the script may run until the next begin()
  std::string kill_message;

  void* host = nullptr;                                // ScriptHost::Impl, for the bindings
  std::function<bool(lua_State*)> is_timeline_thread;  // threads that coroutine.resume must not touch
};

Sandbox& sandbox_of(lua_State*);

// Adds to what the script has spent; beyond the budget the script is killed (does not return).
void charge(lua_State*, std::uint64_t instructions);
// Ends the script: every pcall and coroutine boundary passes the error on.
[[noreturn]] void raise_kill(lua_State*, const std::string& reason);
// The same, because the memory cap was reached.
[[noreturn]] void raise_memory_kill(lua_State*);
// lua_error with the position of the caller in front.
[[noreturn]] void raise(lua_State*, const std::string& message);

// Wraps a binding so that a C++ exception becomes a Lua error. Lua's own errors, which are exceptions of
// another type, pass.
int report_exception(lua_State*, const char* what);
template <LuaFunction F>
int guarded(lua_State* state) {
  std::string what;
  try {
    return F(state);
  } catch (const std::exception& e) {
    what = e.what();
  }
  return report_exception(state, what.c_str());
}

// The standard library, pruned and guarded: sandbox_libraries.cpp.
void open_libraries(lua_State*);
struct LibraryNames {
  const char* library;
  std::vector<const char*> functions;
};
const std::vector<LibraryNames>& library_names();

}  // namespace petrichor::script
