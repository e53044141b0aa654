#pragma once
// Inside the assets box: typed reading of glTF accessors (specification 2.0, section 3.6.2).

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

#include "engine/assets/gltf_document.hpp"

namespace petrichor {

enum class ComponentType { int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126 };

// Elements of an accessor, wherever they lie: in a view (interleaved or not), nowhere (all zeros), or in a
// dense copy where the accessor is sparse. Every element below `count` is inside `data`.
struct AccessorView {
  const std::uint8_t* data = nullptr;  // nullptr: zeros
  std::uint64_t stride_bytes = 0;
  std::uint64_t count = 0;
  int components = 0;
  ComponentType component_type = ComponentType::float32;
  bool normalized = false;
  std::string path;  // "/accessors/3"
  Bytes dense;
};

// Checks every offset before anything is read. The reference lives as long as the document.
AccessorView open_accessor(Document&, int index);

// Element i as numbers, normalised integers mapped to [0,1] or [-1,1]; missing components are 0, 0, 0, 1.
// Fails where a float is not finite.
glm::vec4 read_vector(const AccessorView&, std::uint64_t i);
glm::mat4 read_matrix(const AccessorView&, std::uint64_t i);  // MAT4 of floats
std::uint32_t read_unsigned(const AccessorView&, std::uint64_t i, int component = 0);

}  // namespace petrichor
