#include "engine/script/sandbox.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <lua.hpp>
#include <sstream>

namespace petrichor::script {
namespace {

constexpr int hook_interval = 100;
constexpr std::size_t largest_file_bytes = std::size_t{8} << 20;
constexpr std::size_t spare_for_errors_bytes = std::size_t{4} << 20;

// Large blocks are charged by size (copying them takes time that no hook sees), and so is a refusal, because
// Lua answers it with a full collection.
void* allocate(void* user, void* block, std::size_t old_size, std::size_t new_size) {
  auto& sandbox = *static_cast<Sandbox*>(user);
  const std::size_t old_bytes = block ? old_size : 0;
  if (new_size == 0) {
    std::free(block);
    sandbox.memory_used -= old_bytes;
    return nullptr;
  }
  const std::size_t others = sandbox.memory_used - old_bytes;
  if (new_size > old_bytes) {
    const std::size_t limit = sandbox.limits.memory_bytes + sandbox.memory_spare;
    if (new_size > limit || others > limit - new_size) {
      sandbox.spent += sandbox.memory_used / 16;
      return nullptr;
    }
    if (new_size > 65536) sandbox.spent += new_size / 64;
  }
  void* moved = std::realloc(block, new_size);
  if (moved) sandbox.memory_used = others + new_size;
  return moved;
}

void count_hook(lua_State* state, lua_Debug*) {
  Sandbox& sandbox = sandbox_of(state);
  if (!sandbox.killed) {
    charge(state, hook_interval);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - sandbox.started;
    if (elapsed.count() <= sandbox.limits.wall_s) return;
    raise_kill(state, fmt::format("the script ran for more than {:g} s", sandbox.limits.wall_s));
  }
  raise_kill(state, sandbox.kill_message);
}

struct Kill {};

// "file:line: " of the innermost Lua function, or "".
std::string position(lua_State* state) {
  lua_Debug info;
  for (int level = 0; lua_getstack(state, level, &info); ++level) {
    lua_getinfo(state, "Sl", &info);
    if (info.currentline > 0) return fmt::format("{}:{}: ", info.short_src, info.currentline);
  }
  return "";
}

// Grants a little memory beyond the cap while a failure is put into words.
struct SpareMemory {
  explicit SpareMemory(Sandbox& s) : sandbox(s) { sandbox.memory_spare = spare_for_errors_bytes; }
  ~SpareMemory() { sandbox.memory_spare = 0; }
  Sandbox& sandbox;
};

std::string traceback(lua_State* to, lua_State* of) {
  luaL_traceback(to, of, nullptr, 0);
  std::size_t length = 0;
  const char* text = lua_tolstring(to, -1, &length);
  std::string copy(text, length);
  lua_pop(to, 1);
  return copy;
}

int call_body(lua_State* state) {
  auto& body = *static_cast<const std::function<void(lua_State*)>*>(lua_touserdata(state, 1));
  lua_settop(state, 0);
  body(state);
  return 0;
}

}  // namespace

Sandbox::Sandbox(const ScriptOptions& options)
    : limits(options.limits), roots(options.roots), print(options.services.print), seed(options.seed) {
  state = lua_newstate(allocate, this);
  if (!state) return;  // a cap below what Lua itself needs: every call then fails
  *static_cast<Sandbox**>(lua_getextraspace(state)) = this;
  begin(limits.load_instructions);
  if (!protect([](lua_State* s) { open_libraries(s); })) {
    lua_close(state);
    state = nullptr;
  }
}

Sandbox::~Sandbox() {
  if (state) lua_close(state);
}

void Sandbox::begin(std::uint64_t instructions) {
  budget = instructions;
  spent = 0;
  killed = false;
  kill_message.clear();
  started = std::chrono::steady_clock::now();
  if (state) lua_sethook(state, count_hook, LUA_MASKCOUNT, hook_interval);
}

Result<void> Sandbox::protect(const std::function<void(lua_State*)>& body) {
  if (!state) {
    return failure(fmt::format("the script memory cap of {} bytes is too small for Lua itself", limits.memory_bytes));
  }
  // lua_pushcfunction and lua_pushlightuserdata allocate nothing, so nothing before the pcall can fail.
  lua_pushcfunction(state, guarded<call_body>);
  lua_pushlightuserdata(state, const_cast<void*>(static_cast<const void*>(&body)));
  const int status = lua_pcall(state, 1, 0, 0);
  if (status == LUA_OK) return {};
  std::string text;
  if (killed) {
    text = kill_message;
  } else if (status == LUA_ERRMEM) {
    text = fmt::format("the script needs more than its {} MiB of memory", limits.memory_bytes >> 20);
  } else {
    const char* message = lua_type(state, -1) == LUA_TSTRING ? lua_tostring(state, -1) : nullptr;
    text = message ? message : "an error without a message";
  }
  lua_settop(state, 0);
  return failure(std::move(text));
}

Result<void> Sandbox::load(lua_State* to, const std::filesystem::path& file) {
  if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  const std::string name = file.generic_string();
  std::error_code code;
  if (!std::filesystem::exists(file, code)) return failure(fmt::format("{}: no such script", name));
  if (!std::filesystem::is_regular_file(file, code))
    return failure(fmt::format("{}: not a script but a folder or device", name));
  const auto size = std::filesystem::file_size(file, code);
  if (code || size > largest_file_bytes) {
    return failure(fmt::format("{}: a script may have at most {} MiB", name, largest_file_bytes >> 20));
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  if (!stream) {
    if (size > 0) return failure(fmt::format("{}: cannot be read", name));
  }
  std::string text = std::move(buffer).str();
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  if (text.starts_with('#')) text.insert(0, "--");  // #! line
  charge(to, text.size());
  // "t": text only. Bytecode can crash the machine that runs it (Lua manual, load).
  if (luaL_loadbufferx(to, text.data(), text.size(), ("@" + name).c_str(), "t") != LUA_OK) {
    std::size_t length = 0;
    const char* message = lua_tolstring(to, -1, &length);
    std::string copy = message ? std::string(message, length) : "cannot be compiled";
    lua_pop(to, 1);
    if (copy.find("attempt to load a binary chunk") != std::string::npos) {
      copy = name + ": compiled Lua is not accepted; give the source text";
    }
    return failure(std::move(copy));
  }
  return {};
}

std::string Sandbox::failure_text(lua_State* thread, int status) {
  if (killed) return kill_message;
  std::string text;
  const SpareMemory spare(*this);
  auto told = protect([&](lua_State* s) {
    if (status == LUA_ERRMEM) {
      text =
          position(thread) + fmt::format("the script needs more than its {} MiB of memory", limits.memory_bytes >> 20);
    } else {
      lua_xmove(thread, s, 1);
      // A table or userdata without __tostring says nothing to people; its __tostring is script code, and
      // runs under the hook like any other.
      if (lua_type(s, -1) == LUA_TSTRING || luaL_getmetafield(s, -1, "__tostring") != LUA_TNIL) {
        if (lua_type(s, -1) == LUA_TFUNCTION) lua_pop(s, 1);
        std::size_t length = 0;
        const char* message = luaL_tolstring(s, -1, &length);
        text.assign(message, length);
      } else {
        text = position(thread) + fmt::format("error({}) without a message", luaL_typename(s, -1));
      }
    }
    text += "\n" + traceback(s, thread);
  });
  if (!told && text.empty()) text = told.error().message;
  return text;
}

Sandbox& sandbox_of(lua_State* state) {
  return **static_cast<Sandbox**>(lua_getextraspace(state));
}

void charge(lua_State* state, std::uint64_t instructions) {
  Sandbox& sandbox = sandbox_of(state);
  sandbox.spent += instructions;
  if (sandbox.spent > sandbox.budget) {
    raise_kill(state, fmt::format("the script used more than its {} million instructions without a wait; is there a "
                                  "loop that never ends?",
                                  sandbox.budget / 1'000'000));
  }
}

void raise_kill(lua_State* state, const std::string& reason) {
  Sandbox& sandbox = sandbox_of(state);
  if (!sandbox.killed) {
    sandbox.killed = true;
    sandbox.kill_message = position(state) + reason;
    const SpareMemory spare(sandbox);
    sandbox.kill_message += "\n" + traceback(state, state);
  }
  // From here on every single instruction of this thread is stopped again: no __close metamethod gets further.
  lua_sethook(state, count_hook, LUA_MASKCOUNT, 1);
  // Not an error of Lua's but a foreign exception: it passes all the pcalls of a thread at once (Lua unwinds them
  // one by one, which is quadratic in their depth) and comes out of lua_resume, or lua_pcall, with status -1.
  throw Kill{};
}

void raise_memory_kill(lua_State* state) {
  const std::size_t cap = sandbox_of(state).limits.memory_bytes;
  raise_kill(state, fmt::format("the script needs more than its {} MiB of memory", cap >> 20));
}

void raise(lua_State* state, const std::string& message) {
  luaL_where(state, 1);
  lua_pushlstring(state, message.data(), message.size());
  lua_concat(state, 2);
  lua_error(state);
  std::abort();
}

int report_exception(lua_State* state, const char* what) {
  return luaL_error(state, "%s", what);
}

}  // namespace petrichor::script
