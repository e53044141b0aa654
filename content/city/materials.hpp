#pragma once
// The glTF materials: textures made and encoded, one entry per Mat.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "content/city/scene.hpp"

namespace petrichor::city {

struct EncodedImage {
  std::string name;
  std::string mime_type;
  std::vector<std::uint8_t> bytes;
};

struct MaterialSet {
  std::vector<EncodedImage> images;
  // A glTF material object for each used Mat, in the order of the enum; texture indices equal image indices.
  std::vector<std::string> json;
  std::vector<int> index_of;  // per Mat, -1 where the scene does not use it
};

MaterialSet make_materials(const Scene&, bool textures);

}  // namespace petrichor::city
