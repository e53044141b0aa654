#include "engine/assets/gltf_accessor.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

namespace petrichor {
namespace {

using nlohmann::json;

// Accessors without data are backed by nothing that bounds their count, so this does.
constexpr std::uint64_t maximum_zero_elements = 1u << 22;
constexpr std::uint64_t maximum_dense_bytes = 1u << 30;

std::uint64_t size_of(ComponentType type) {
  switch (type) {
    case ComponentType::int8:
    case ComponentType::uint8:
      return 1;
    case ComponentType::int16:
    case ComponentType::uint16:
      return 2;
    case ComponentType::uint32:
    case ComponentType::float32:
      return 4;
  }
  return 0;
}

std::optional<ComponentType> component_type(int value) {
  switch (value) {
    case 5120:
    case 5121:
    case 5122:
    case 5123:
    case 5125:
    case 5126:
      return static_cast<ComponentType>(value);
    default:
      return std::nullopt;
  }
}

// Columns of small matrices start on 4-byte boundaries (section 3.6.2.4); only 4x4 floats are read here, for
// which that changes nothing.
int component_count(int tinygltf_type) {
  switch (tinygltf_type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    case TINYGLTF_TYPE_MAT2:
      return 4;
    case TINYGLTF_TYPE_MAT3:
      return 9;
    default:
      return 16;
  }
}

template <class T>
T load(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

// Section 3.6.2.2 and, for signed normalised values, the max() of section 3.11.
float load_component(const AccessorView& view, std::uint64_t i, int component) {
  if (view.data == nullptr) return 0.0f;
  const std::uint8_t* at =
      view.data + i * view.stride_bytes + static_cast<std::uint64_t>(component) * size_of(view.component_type);
  switch (view.component_type) {
    case ComponentType::int8: {
      const float v = load<std::int8_t>(at);
      return view.normalized ? std::max(v / 127.0f, -1.0f) : v;
    }
    case ComponentType::uint8: {
      const float v = load<std::uint8_t>(at);
      return view.normalized ? v / 255.0f : v;
    }
    case ComponentType::int16: {
      const float v = load<std::int16_t>(at);
      return view.normalized ? std::max(v / 32767.0f, -1.0f) : v;
    }
    case ComponentType::uint16: {
      const float v = load<std::uint16_t>(at);
      return view.normalized ? v / 65535.0f : v;
    }
    case ComponentType::uint32:
      return static_cast<float>(load<std::uint32_t>(at));
    case ComponentType::float32:
      break;
  }
  const float v = load<float>(at);
  if (!std::isfinite(v)) gltf_fail(view.path, fmt::format("element {} holds {}, finite numbers are needed", i, v));
  return v;
}

// The bytes of a view from an offset on, if `count` elements of `element` bytes, `stride` apart, fit.
std::span<const std::uint8_t> range(const Document& document, int view_index, std::uint64_t offset,
                                    std::uint64_t stride, std::uint64_t count, std::uint64_t element,
                                    const std::string& path) {
  const auto bytes = bytes_of_view(document, view_index);
  // count <= 2^53 and stride <= 252: the product could pass 2^64, so divide instead.
  const bool fits = offset <= bytes.size() && bytes.size() - offset >= element &&
                    (count - 1) <= (bytes.size() - offset - element) / stride;
  if (!fits) {
    gltf_fail(
        path,
        fmt::format(
            "{} elements of {} bytes, {} apart, from byte {} on do not fit into /bufferViews/{}, which has {} bytes",
            count, element, stride, offset, view_index, bytes.size()));
  }
  return bytes.subspan(offset);
}

void apply_sparse(Document& document, const tinygltf::Accessor& accessor, AccessorView& view, std::uint64_t element) {
  const auto& sparse = accessor.sparse;
  const std::string path = view.path + "/sparse";
  const std::uint64_t count = (*document.json)[json::json_pointer(path + "/count")].get<std::uint64_t>();
  if (count > view.count)
    gltf_fail(path + "/count", fmt::format("{} is more than the accessor's count of {}", count, view.count));
  const auto index_type = component_type(sparse.indices.componentType);
  if (!index_type || *index_type == ComponentType::int16 || *index_type == ComponentType::float32) {
    gltf_fail(path + "/indices/componentType",
              fmt::format("{}, 5121, 5123 or 5125 is needed", sparse.indices.componentType));
  }
  AccessorView indices;
  indices.stride_bytes = size_of(*index_type);
  indices.component_type = *index_type;
  indices.count = count;
  indices.components = 1;
  indices.path = path + "/indices";
  indices.data = range(document, sparse.indices.bufferView, static_cast<std::uint64_t>(sparse.indices.byteOffset),
                       indices.stride_bytes, count, indices.stride_bytes, indices.path)
                     .data();
  const auto values = range(document, sparse.values.bufferView, static_cast<std::uint64_t>(sparse.values.byteOffset),
                            element, count, element, path + "/values");
  document.dense_bytes += view.count * element;
  if (document.dense_bytes > maximum_dense_bytes)
    gltf_fail(path, fmt::format("all sparse accessors pass {} bytes", maximum_dense_bytes));
  view.dense.resize(view.count * element);
  if (view.data != nullptr) {
    for (std::uint64_t i = 0; i < view.count; ++i) {
      std::memcpy(view.dense.data() + i * element, view.data + i * view.stride_bytes, element);
    }
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t target = read_unsigned(indices, i);
    if (target >= view.count) {
      gltf_fail(indices.path, fmt::format("entry {} is {}, the accessor has {} elements", i, target, view.count));
    }
    std::memcpy(view.dense.data() + target * element, values.data() + i * element, element);
  }
  view.data = view.dense.data();
  view.stride_bytes = element;
}

}  // namespace

AccessorView open_accessor(Document& document, int index) {
  if (const auto known = document.sparse_accessors.find(index); known != document.sparse_accessors.end()) {
    AccessorView copy;
    const AccessorView& dense = *known->second;
    copy.data = dense.data;
    copy.stride_bytes = dense.stride_bytes;
    copy.count = dense.count;
    copy.components = dense.components;
    copy.component_type = dense.component_type;
    copy.normalized = dense.normalized;
    copy.path = dense.path;
    return copy;
  }
  const tinygltf::Accessor& accessor = document.gltf->accessors[static_cast<std::size_t>(index)];
  AccessorView view;
  view.path = fmt::format("/accessors/{}", index);
  const auto type = component_type(accessor.componentType);
  if (!type) {
    gltf_fail(view.path + "/componentType",
              fmt::format("{}, one of 5120, 5121, 5122, 5123, 5125, 5126 is needed", accessor.componentType));
  }
  view.component_type = *type;
  view.components = component_count(accessor.type);
  view.normalized = accessor.normalized;
  view.count = accessor.count;
  const std::uint64_t element = size_of(*type) * static_cast<std::uint64_t>(view.components);
  view.stride_bytes = element;
  if ((*document.json)["accessors"][static_cast<std::size_t>(index)].contains("bufferView")) {
    const auto& buffer_view = document.gltf->bufferViews[static_cast<std::size_t>(accessor.bufferView)];
    if (buffer_view.byteStride != 0) {
      view.stride_bytes = buffer_view.byteStride;
      if (view.stride_bytes < element) {
        gltf_fail(
            fmt::format("/bufferViews/{}/byteStride", accessor.bufferView),
            fmt::format("{} is less than the {} bytes of an element of {}", view.stride_bytes, element, view.path));
      }
    }
    view.data =
        range(document, accessor.bufferView, accessor.byteOffset, view.stride_bytes, view.count, element, view.path)
            .data();
  } else {
    document.zero_elements += view.count;
    if (view.count > maximum_zero_elements || document.zero_elements > maximum_zero_elements) {
      gltf_fail(view.path + "/count", fmt::format("{} elements without a bufferView; the whole model may use {}",
                                                  view.count, maximum_zero_elements));
    }
  }
  if (!accessor.sparse.isSparse) return view;
  apply_sparse(document, accessor, view, element);
  document.sparse_accessors[index] = std::make_unique<AccessorView>(std::move(view));
  return open_accessor(document, index);
}

glm::vec4 read_vector(const AccessorView& view, std::uint64_t i) {
  glm::vec4 out{0.0f, 0.0f, 0.0f, 1.0f};
  for (int c = 0; c < std::min(view.components, 4); ++c) out[c] = load_component(view, i, c);
  return out;
}

glm::mat4 read_matrix(const AccessorView& view, std::uint64_t i) {
  glm::mat4 out{1.0f};
  if (view.components != 16) return out;
  for (int c = 0; c < 16; ++c) out[c / 4][c % 4] = load_component(view, i, c);
  return out;
}

std::uint32_t read_unsigned(const AccessorView& view, std::uint64_t i, int component) {
  if (view.data == nullptr) return 0;
  const std::uint8_t* at =
      view.data + i * view.stride_bytes + static_cast<std::uint64_t>(component) * size_of(view.component_type);
  switch (view.component_type) {
    case ComponentType::uint8:
      return load<std::uint8_t>(at);
    case ComponentType::uint16:
      return load<std::uint16_t>(at);
    case ComponentType::uint32:
      return load<std::uint32_t>(at);
    default:
      return 0;
  }
}

}  // namespace petrichor
