#include "engine/app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace petrichor {

using Clock = std::chrono::steady_clock;

Progress::Progress(std::string label, std::int64_t total)
    : label_(std::move(label)),
      total_(std::max<std::int64_t>(total, 1)),
      terminal_(isatty(STDERR_FILENO)),
      start_(Clock::now()) {}

Progress::~Progress() {
  if (terminal_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::advance_to(std::int64_t done) {
  const auto now = Clock::now();
  if (!terminal_ || (done < total_ && now - last_ < std::chrono::milliseconds(100))) return;
  last_ = now;
  const double fraction = std::clamp(static_cast<double>(done) / static_cast<double>(total_), 0.0, 1.0);
  const double spent_s = std::chrono::duration<double>(now - start_).count();
  const int left_s = fraction > 0.0 ? static_cast<int>(spent_s * (1.0 - fraction) / fraction + 0.5) : 0;
  constexpr int width = 30;
  const int full = static_cast<int>(fraction * width);
  fmt::print(stderr, "\r\x1b[K{} [{}{}] {}/{}  {}:{:02} left", label_, std::string(full, '#'),
             std::string(width - full, '.'), done, total_, left_s / 60, left_s % 60);
  std::fflush(stderr);
}

}  // namespace petrichor
