#pragma once
// Where the program's own files are, where the user's go, and how a file is written whole.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace petrichor {

// Folders that may hold scripts/, systems/ and content/, first the one that wins: $PETRICHOR_DATA, the
// program's folder, ../share/petrichor beside it (an installed program), the source tree it was built in.
std::vector<std::filesystem::path> data_roots();

// The first `relative` that exists under data_roots(); the error lists where it looked. An absolute
// path is returned if it exists.
Result<std::filesystem::path> find_data(const std::filesystem::path& relative);

std::filesystem::path executable_folder();  // empty where the system does not tell

// $XDG_CONFIG_HOME/petrichor and so on, with the defaults of the XDG Base Directory Specification 0.8; a
// relative value is ignored, as it asks. Without $HOME: a folder of this user's in the temporary folder.
// They are not created.
std::filesystem::path user_config_dir();
std::filesystem::path user_cache_dir();
std::filesystem::path user_state_dir();

// Errors name the path and the system's reason.
Result<std::string> read_whole_file(const std::filesystem::path&);

// Writes beside the target and renames when whole, so that a reader sees the old file or the new one
// and never half of one; makes missing folders. A target that is no regular file (/dev/stdout, a pipe) is
// written in place. Errors name the path and the reason (read-only folder, disk full).
Result<void> write_whole_file(const std::filesystem::path&, std::span<const std::byte> bytes);
Result<void> write_whole_file(const std::filesystem::path&, std::string_view text);

}  // namespace petrichor
