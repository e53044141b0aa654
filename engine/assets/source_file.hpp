#pragma once
// Bytes behind a model file and the URIs inside it. Nothing here trusts what it reads: only regular files
// are opened, sizes are bounded before anything is allocated, and a URI never leads out of the model's folder.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace petrichor {

using Bytes = std::vector<std::uint8_t>;

inline constexpr std::uint64_t maximum_file_bytes = 2ull << 30;

// The whole file. Errors: missing, no regular file (folder, FIFO, device), empty, larger than
// maximum_file_bytes, unreadable.
Result<Bytes> read_regular_file(const std::filesystem::path& file);

bool is_data_uri(std::string_view uri);

// "data:[type][;base64],payload" (RFC 2397).
Result<Bytes> decode_data_uri(std::string_view uri);

// The file that a relative URI reference (RFC 3986, percent-encoded) names beside the model. Refused: other
// schemes, absolute paths, and paths that leave the folder by "..": a model from a stranger must not make
// us open files elsewhere. Symbolic links inside the folder are the user's own doing and are followed.
Result<std::filesystem::path> resolve_uri(const std::filesystem::path& folder, std::string_view uri);

}  // namespace petrichor
