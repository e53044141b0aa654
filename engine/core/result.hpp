#pragma once
// Loading, compiling and script failures are values: a Result holds the thing or a message that says
// what went wrong, where (file:line, JSON path, pass, resource) and what to do.

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace petrichor {

struct Error {
  std::string message;
  bool wrong_call = false;  // what the user asked for makes no sense, as against work that failed
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> failure(std::string message) {
  return tl::unexpected<Error>(Error{std::move(message)});
}

inline tl::unexpected<Error> wrong_call(std::string message) {
  return tl::unexpected<Error>(Error{std::move(message), true});
}

}  // namespace petrichor
