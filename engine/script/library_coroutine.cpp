// Coroutines of the script's own. A kill passes through all of them.

#include <lua.hpp>

#include "engine/script/library.hpp"

namespace petrichor::script {
namespace {

lua_State* coroutine_argument(lua_State* state) {
  lua_State* thread = lua_tothread(state, 1);
  luaL_argexpected(state, thread, 1, "coroutine");
  const Sandbox& sandbox = sandbox_of(state);
  if (sandbox.is_timeline_thread && sandbox.is_timeline_thread(thread)) {
    luaL_error(state, "this coroutine belongs to the timeline, which resumes it when it is due");
  }
  return thread;
}

int create_coroutine(lua_State* state) {
  luaL_checktype(state, 1, LUA_TFUNCTION);
  charge(state, 200);                        // instructions that its first hook has not seen yet, many times over
  lua_State* thread = lua_newthread(state);  // inherits the hook
  lua_pushvalue(state, 1);
  lua_xmove(state, thread, 1);
  return 1;
}

// Resumes with `count` arguments from the top of `state`; leaves results or the error there. -1 on error.
int resume_with(lua_State* state, lua_State* thread, int count) {
  charge(state, 10);
  if (!lua_checkstack(thread, count)) {
    lua_pushliteral(state, "too many arguments to resume");
    return -1;
  }
  lua_xmove(state, thread, count);
  int results = 0;
  const int status = lua_resume(thread, state, count, &results);
  Sandbox& sandbox = sandbox_of(state);
  if (sandbox.killed) raise_kill(state, sandbox.kill_message);
  if (status == LUA_ERRMEM) {
    raise_memory_kill(state);
  }
  if (status == LUA_OK || status == LUA_YIELD) {
    if (!lua_checkstack(state, results + 1)) {
      lua_pop(thread, results);
      lua_pushliteral(state, "too many results to resume");
      return -1;
    }
    lua_xmove(thread, state, results);
    return results;
  }
  lua_xmove(thread, state, 1);
  return -1;
}

int resume_coroutine(lua_State* state) {
  lua_State* thread = coroutine_argument(state);
  const int results = resume_with(state, thread, lua_gettop(state) - 1);
  lua_pushboolean(state, results >= 0);
  lua_insert(state, results >= 0 ? -(results + 1) : -2);
  return results >= 0 ? results + 1 : 2;
}

// Runs a thread's pending __close metamethods. Lua 5.4.4 does not count the C stack across this call, so the
// nesting is counted here.
int close_thread(lua_State* state, lua_State* thread) {
  Sandbox& sandbox = sandbox_of(state);
  if (sandbox.closing >= 8) luaL_error(state, "coroutines are closed inside one another too deep");
  ++sandbox.closing;
  const int status = lua_resetthread(thread);
  --sandbox.closing;
  if (sandbox.killed) raise_kill(state, sandbox.kill_message);
  return status;
}

int call_wrapped(lua_State* state) {
  lua_State* thread = lua_tothread(state, lua_upvalueindex(1));
  const int results = resume_with(state, thread, lua_gettop(state));
  if (results >= 0) return results;
  const int status = lua_status(thread);
  if (status != LUA_OK && status != LUA_YIELD && close_thread(state, thread) != LUA_OK) {
    lua_xmove(thread, state, 1);  // an error in closing takes the place of the first
  }
  return lua_error(state);
}

int wrap_coroutine(lua_State* state) {
  create_coroutine(state);
  lua_pushcclosure(state, guarded<call_wrapped>, 1);
  return 1;
}

int close_coroutine(lua_State* state) {
  lua_State* thread = coroutine_argument(state);
  if (lua_gethookcount(thread) == 1) {  // killed: its hooks are off for ever, so nothing of it may run
    lua_pushboolean(state, 0);
    lua_pushliteral(state, "killed");
    return 2;
  }
  const int status = lua_status(thread);
  lua_Debug info;
  const bool idle = status == LUA_YIELD ||
                    (status == LUA_OK && thread != state && lua_getstack(thread, 0, &info) == 0) || status > LUA_YIELD;
  if (!idle) return luaL_error(state, "cannot close a running coroutine");
  const int closed = close_thread(state, thread);
  lua_pushboolean(state, closed == LUA_OK);
  if (closed == LUA_OK) return 1;
  lua_xmove(thread, state, 1);
  return 2;
}

constexpr LibraryFunction functions[] = {{"coroutine", "create", guarded<create_coroutine>},
                                         {"coroutine", "resume", guarded<resume_coroutine>},
                                         {"coroutine", "wrap", guarded<wrap_coroutine>},
                                         {"coroutine", "close", guarded<close_coroutine>}};

}  // namespace

std::span<const LibraryFunction> coroutine_library() {
  return functions;
}

}  // namespace petrichor::script
