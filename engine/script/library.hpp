#pragma once
// Inside engine/script: the functions that replace, or stand in front of, those of Lua's library.

#include <span>

#include "engine/script/sandbox.hpp"

namespace petrichor::script {

struct LibraryFunction {
  const char* library;  // "" for the globals
  const char* name;
  LuaFunction function;
  // A guard is a closure over Lua's own function, which it calls in its very frame; upvalue 2 is `flag`.
  bool is_guard = false;
  bool flag = false;
};

std::span<const LibraryFunction> base_library();   // protected calls, metatables, print, random numbers
std::span<const LibraryFunction> order_library();  // pairs and next in an order of their own
std::span<const LibraryFunction> require_library();
std::span<const LibraryFunction> coroutine_library();
std::span<const LibraryFunction> guard_library();  // string, utf8, table: loops in C, where no hook runs

// Worst-case steps of a Lua pattern on a text of `length` bytes: the matcher backtracks.
double pattern_cost(std::string_view pattern, std::size_t length);

}  // namespace petrichor::script
