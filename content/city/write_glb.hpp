#pragma once
// The scene as one binary glTF 2.0 file (Khronos glTF 2.0 specification, section 4.4: header, JSON, BIN).

#include <filesystem>

#include "content/city/scene.hpp"
#include "engine/core/result.hpp"

namespace petrichor::city {

struct WriteOptions {
  bool textures = true;  // off only for quick looks at the geometry
};

Result<std::vector<std::uint8_t>> glb_bytes(const Scene&, const WriteOptions&);
Result<void> write_file(const std::filesystem::path&, const std::vector<std::uint8_t>&);

}  // namespace petrichor::city
