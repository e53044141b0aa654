#pragma once
#include <chrono>
#include <filesystem>
#include <vector>

namespace petrichor {

// Tells which of some files changed on disk since it was last asked.
class FileWatch {
 public:
  void watch(const std::vector<std::filesystem::path>& files);
  bool changed();  // true once per change

 private:
  struct Seen {
    std::filesystem::path file;
    std::filesystem::file_time_type time;
  };
  std::vector<Seen> seen_;
};

}  // namespace petrichor
