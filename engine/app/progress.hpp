#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace petrichor {

// A bar with the time left on standard error; silent where that is no terminal.
class Progress {
 public:
  Progress(std::string label, std::int64_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void advance_to(std::int64_t done);

 private:
  std::string label_;
  std::int64_t total_;
  bool terminal_;
  std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace petrichor
