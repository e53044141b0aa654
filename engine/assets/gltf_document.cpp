#include "engine/assets/gltf_document.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/assets/gltf_accessor.hpp"

namespace petrichor {
namespace {

using nlohmann::json;

constexpr std::size_t maximum_nesting = 512;            // recursion of tinygltf and json::dump stays small
constexpr std::size_t maximum_json_values = 8'000'000;  // over half a gigabyte once parsed
constexpr std::size_t maximum_warnings = 100;

std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t offset) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + offset, 4);
  return value;
}

struct Container {
  std::span<const std::uint8_t> text;
  std::span<const std::uint8_t> chunk;
};

// glTF 2.0, section 4.4: 12-byte header, then chunks of length, type, data.
Container split_glb(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 20) gltf_fail("", fmt::format("a GLB has at least 20 bytes, this file {}", bytes.size()));
  if (const auto version = read_u32(bytes, 4); version != 2) {
    gltf_fail("", fmt::format("GLB version {}, 2 is needed", version));
  }
  const std::uint64_t length = read_u32(bytes, 8);
  if (length > bytes.size()) {
    gltf_fail("", fmt::format("truncated: the GLB header says {} bytes, the file has {}", length, bytes.size()));
  }
  Container out;
  std::uint64_t offset = 12;
  for (int chunk = 0; offset + 8 <= length; ++chunk) {
    const std::uint64_t size = read_u32(bytes, offset);
    const std::uint32_t type = read_u32(bytes, offset + 4);
    offset += 8;
    if (size > length - offset) {
      gltf_fail("", fmt::format("GLB chunk {} says {} bytes, {} are left", chunk, size, length - offset));
    }
    const auto data = bytes.subspan(offset, size);
    if (chunk == 0) {
      if (type != 0x4E4F534A) gltf_fail("", "the first GLB chunk is not JSON");
      out.text = data;
    } else if (type == 0x004E4942 && out.chunk.empty()) {
      out.chunk = data;
    }
    offset += size;
  }
  if (out.text.empty()) gltf_fail("", "the GLB holds no JSON");
  return out;
}

// Bounds the nesting and the number of values before any parser sees the text.
void scan_json(std::span<const std::uint8_t> text) {
  std::size_t depth = 0, values = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint8_t c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      ++values;
      if (++depth > maximum_nesting)
        gltf_fail("", fmt::format("JSON nested deeper than {} at byte {}", maximum_nesting, i));
    } else if (c == '}' || c == ']') {
      if (depth > 0) --depth;
    } else if (c == ',') {
      ++values;
    }
  }
  if (values > maximum_json_values) gltf_fail("", fmt::format("JSON of more than {} values", maximum_json_values));
}

json parse_json(std::span<const std::uint8_t> text) {
  scan_json(text);
  json document;
  try {
    document = json::parse(text.begin(), text.end());
  } catch (const json::exception& e) {
    gltf_fail("", fmt::format("no JSON: {}", e.what()));
  }
  if (!document.is_object()) gltf_fail("", "the JSON is no object");
  return document;
}

// tinygltf gets what it parses well and nothing it could stumble over: no buffers and images (it wants
// external files to be exactly byteLength long, and turns "+" into a blank), no extras (they stay in our own
// JSON), no extensions, no cameras and lights, and a view for every accessor (it refuses indices without
// one, which the specification allows: an accessor of zeros, or sparse).
json for_tinygltf(const json& document) {
  json out = json::object();
  const auto bare = [](const json& element) {
    json copy = element;
    copy.erase("extras");
    copy.erase("extensions");
    return copy;
  };
  for (const char* name : {"scenes", "nodes", "accessors", "bufferViews", "textures", "samplers"}) {
    if (!document.contains(name)) continue;
    json& list = out[name] = json::array();
    for (const json& element : document[name]) list.push_back(bare(element));
  }
  if (document.contains("meshes")) {
    json& list = out["meshes"] = json::array();
    for (const json& mesh : document["meshes"]) {
      json copy = bare(mesh);
      for (json& primitive : copy["primitives"]) primitive = bare(primitive);
      list.push_back(std::move(copy));
    }
  }
  if (document.contains("materials")) {
    json& list = out["materials"] = json::array();
    for (const json& material : document["materials"]) {
      json copy = bare(material);
      for (auto& [key, value] : copy.items()) {
        if (!value.is_object()) continue;
        value = bare(value);
        for (auto& [inner_key, inner] : value.items()) {
          if (inner.is_object()) inner = bare(inner);
        }
      }
      list.push_back(std::move(copy));
    }
  }
  out["asset"] = {{"version", "2.0"}};
  if (document.contains("scene")) out["scene"] = document["scene"];
  return out;
}

void parse_gltf(Document& document) {
  json reduced = for_tinygltf(*document.json);
  if (reduced.contains("accessors")) {
    const std::size_t spare = reduced.contains("bufferViews") ? reduced["bufferViews"].size() : 0;
    bool needed = false;
    for (json& accessor : reduced["accessors"]) {
      if (accessor.contains("bufferView")) continue;
      accessor["bufferView"] = spare;  // AccessorView looks into our own JSON for the truth
      needed = true;
    }
    if (needed) reduced["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
  }
  const std::string text = reduced.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > maximum_file_bytes) gltf_fail("", "the JSON is too large");
  tinygltf::TinyGLTF parser;
  std::string error, warning;
  if (!parser.LoadASCIIFromString(document.gltf.get(), &error, &warning, text.data(),
                                  static_cast<unsigned int>(text.size()), "")) {
    gltf_fail("", error.empty() ? "no glTF 2.0 that can be read" : error);
  }
}

void check_asset(Document& document) {
  const json& asset = (*document.json)["asset"];
  const std::string version = asset["version"];
  if (version.rfind("2.", 0) != 0)
    gltf_fail("/asset/version", fmt::format("\"{}\", 2.0 is needed", version.substr(0, 40)));
  if (asset.contains("minVersion") && asset["minVersion"] != "2.0") {
    gltf_fail("/asset/minVersion",
              fmt::format("{} is asked for, this loader reads 2.0", asset["minVersion"].dump().substr(0, 40)));
  }
}

void find_buffers(Document& document) {
  if (!document.json->contains("buffers")) return;
  const json& buffers = (*document.json)["buffers"];
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string path = fmt::format("/buffers/{}", i);
    const std::uint64_t needed = buffers[i]["byteLength"];
    std::span<const std::uint8_t> bytes;
    if (buffers[i].contains("uri")) {
      bytes = bytes_of_uri(document, buffers[i]["uri"].get_ref<const std::string&>(), path + "/uri");
    } else if (i == 0 && document.glb_chunk.data() != nullptr) {
      bytes = document.glb_chunk;
    } else {
      document.buffers.emplace_back();  // allowed; an error once something reads it
      continue;
    }
    if (bytes.size() < needed) {
      gltf_fail(path + "/byteLength", fmt::format("{} bytes are asked for, there are {}", needed, bytes.size()));
    }
    document.buffers.push_back(bytes.first(needed));
  }
}

}  // namespace

Document::Document() : json(std::make_unique<nlohmann::json>()), gltf(std::make_unique<tinygltf::Model>()) {}
Document::~Document() = default;

void Document::warn(const std::string& path, const std::string& message) {
  if (warnings.size() > maximum_warnings) return;
  if (warnings.size() == maximum_warnings) {
    warnings.push_back(fmt::format("{}: more warnings left out", file.string()));
    return;
  }
  warnings.push_back(path.empty() ? fmt::format("{}: {}", file.string(), message)
                                  : fmt::format("{}: {}: {}", file.string(), path, message));
}

void gltf_fail(std::string path, std::string message) {
  throw GltfError{std::move(path), std::move(message)};
}

std::span<const std::uint8_t> bytes_of_uri(Document& document, const std::string& uri, const std::string& path) {
  if (is_data_uri(uri)) {
    auto bytes = decode_data_uri(uri);
    if (!bytes) gltf_fail(path, bytes.error().message);
    return document.data_uris.emplace_back(std::move(*bytes));
  }
  const auto file = resolve_uri(document.file.parent_path(), uri);
  if (!file) gltf_fail(path, file.error().message);
  const auto known = document.external_files.find(file->string());
  if (known != document.external_files.end()) return known->second;
  auto bytes = read_regular_file(*file);
  if (!bytes) gltf_fail(path, bytes.error().message);
  return document.external_files.emplace(file->string(), std::move(*bytes)).first->second;
}

std::span<const std::uint8_t> bytes_of_view(const Document& document, int index) {
  const std::string path = fmt::format("/bufferViews/{}", index);
  const json& view = (*document.json)["bufferViews"][static_cast<std::size_t>(index)];
  const std::size_t buffer_index = view["buffer"];
  const std::uint64_t offset = view.value("byteOffset", std::uint64_t{0});
  const std::uint64_t length = view["byteLength"];
  const auto buffer = document.buffers[buffer_index];
  if (buffer.empty())
    gltf_fail(fmt::format("/buffers/{}", buffer_index), "has neither a uri nor a GLB chunk, yet is read");
  if (offset > buffer.size() || length > buffer.size() - offset) {
    gltf_fail(path + (offset > buffer.size() ? "/byteOffset" : "/byteLength"),
              fmt::format("bytes {} to {} are asked for, /buffers/{} has {}", offset, offset + length, buffer_index,
                          buffer.size()));
  }
  return buffer.subspan(offset, length);
}

void check_extensions(Document& document) {
  // Not here though often met: Draco and meshopt compression, Basis textures. They need decoders of their own.
  static const std::set<std::string> supported{
      "KHR_lights_punctual", "KHR_materials_emissive_strength",     "KHR_texture_transform", "KHR_mesh_quantization",
      "KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness", "EXT_texture_webp"};
  const auto each = [&](const char* name, auto&& use) {
    if (!document.json->contains(name)) return;
    const json& list = (*document.json)[name];
    for (std::size_t i = 0; i < list.size(); ++i)
      use(list[i].get<std::string>().substr(0, 100), fmt::format("/{}/{}", name, i));
  };
  each("extensionsRequired", [&](const std::string& extension, const std::string& path) {
    if (!supported.contains(extension))
      gltf_fail(path, fmt::format("the required extension {} is not supported", extension));
  });
  std::set<std::string> seen;
  each("extensionsUsed", [&](const std::string& extension, const std::string& path) {
    if (!supported.contains(extension) && seen.insert(extension).second) {
      document.warn(path, fmt::format("the optional extension {} is not supported and has no effect", extension));
    }
  });
}

void open_document(Document& document, const std::filesystem::path& file) {
  document.file = file;
  auto bytes = read_regular_file(file);
  if (!bytes) throw GltfError{"", bytes.error().message.substr(file.string().size() + 2)};
  document.file_bytes = std::move(*bytes);
  Container container{document.file_bytes, {}};
  if (document.file_bytes.size() >= 4 && std::memcmp(document.file_bytes.data(), "glTF", 4) == 0) {
    container = split_glb(document.file_bytes);
  }
  *document.json = parse_json(container.text);
  document.glb_chunk = container.chunk;
  validate_json(*document.json);
  check_asset(document);
  check_extensions(document);
  parse_gltf(document);
  find_buffers(document);
}

}  // namespace petrichor
