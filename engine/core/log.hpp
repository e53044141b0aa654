#pragma once
// One line per event on standard error, through spdlog. Usage: log_info("{} drops", n).

#include <fmt/core.h>

#include <string_view>
#include <utility>

namespace petrichor {

enum class LogLevel { debug, info, warn, error, off };

// Messages below the level are dropped; info at start. Colours only on a terminal.
void set_log_level(LogLevel);
bool is_logged(LogLevel);
void log_line(LogLevel, std::string_view);

template <class... Args>
void log_debug(fmt::format_string<Args...> format, Args&&... args) {
  if (is_logged(LogLevel::debug)) log_line(LogLevel::debug, fmt::format(format, std::forward<Args>(args)...));
}

template <class... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
  if (is_logged(LogLevel::info)) log_line(LogLevel::info, fmt::format(format, std::forward<Args>(args)...));
}

template <class... Args>
void log_warn(fmt::format_string<Args...> format, Args&&... args) {
  if (is_logged(LogLevel::warn)) log_line(LogLevel::warn, fmt::format(format, std::forward<Args>(args)...));
}

template <class... Args>
void log_error(fmt::format_string<Args...> format, Args&&... args) {
  if (is_logged(LogLevel::error)) log_line(LogLevel::error, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace petrichor
