#include "content/city/write_glb.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "content/city/materials.hpp"

namespace petrichor::city {
namespace {

using nlohmann::json;

constexpr int target_vertices = 34962;
constexpr int target_indices = 34963;
constexpr int component_ushort = 5123;
constexpr int component_uint = 5125;
constexpr int component_float = 5126;

struct Writer {
  json root;
  std::vector<std::uint8_t> bin;

  int view(const void* data, std::size_t bytes, int target) {
    bin.resize((bin.size() + 3) & ~std::size_t{3}, 0);
    json v{{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes}};
    if (target) v["target"] = target;
    root["bufferViews"].push_back(v);
    const auto* first = static_cast<const std::uint8_t*>(data);
    bin.insert(bin.end(), first, first + bytes);
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }

  int accessor(int view_index, int component, std::size_t count, const char* type) {
    root["accessors"].push_back(
        {{"bufferView", view_index}, {"componentType", component}, {"count", count}, {"type", type}});
    return static_cast<int>(root["accessors"].size()) - 1;
  }

  template <class T>
  int floats(const std::vector<T>& values, const char* type) {
    return accessor(view(values.data(), values.size() * sizeof(T), target_vertices), component_float, values.size(),
                    type);
  }
};

// Per-vertex tangents along +u (averaged over the triangles that share the vertex, as Lengyel does).
std::vector<glm::vec4> tangents(const Primitive& p) {
  std::vector<glm::vec3> along(p.vertices.size(), glm::vec3(0.0f));
  std::vector<glm::vec3> across(p.vertices.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3) {
    const Vertex& a = p.vertices[p.indices[i]];
    const Vertex& b = p.vertices[p.indices[i + 1]];
    const Vertex& c = p.vertices[p.indices[i + 2]];
    const glm::vec3 e1 = b.position_m - a.position_m;
    const glm::vec3 e2 = c.position_m - a.position_m;
    const glm::vec2 d1 = b.uv - a.uv;
    const glm::vec2 d2 = c.uv - a.uv;
    const float area = d1.x * d2.y - d2.x * d1.y;
    if (std::abs(area) < 1e-12f) continue;
    const glm::vec3 t = (e1 * d2.y - e2 * d1.y) / area;
    const glm::vec3 s = (e2 * d1.x - e1 * d2.x) / area;
    for (int k = 0; k < 3; ++k) {
      along[p.indices[i + static_cast<std::size_t>(k)]] += t;
      across[p.indices[i + static_cast<std::size_t>(k)]] += s;
    }
  }
  std::vector<glm::vec4> out(p.vertices.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const glm::vec3 n = p.vertices[i].normal;
    glm::vec3 t = along[i] - n * glm::dot(n, along[i]);
    if (glm::length(t) < 1e-8f) t = glm::cross(n, std::abs(n.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0));
    t = glm::normalize(t);
    // glTF: bitangent = cross(normal, tangent) * w points to +v of the picture's up, which is -v here.
    out[i] = glm::vec4(t, glm::dot(glm::cross(n, t), across[i]) > 0.0f ? -1.0f : 1.0f);
  }
  return out;
}

json write_primitive(Writer& w, Mat mat, const Primitive& p, int material) {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> uvs;
  std::vector<glm::vec2> depths;
  std::vector<std::uint16_t> colours;
  glm::vec3 low(1e9f);
  glm::vec3 high(-1e9f);
  bool coloured = false;
  bool puddled = false;
  for (const Vertex& v : p.vertices) {
    positions.push_back(v.position_m);
    normals.push_back(v.normal);
    uvs.push_back(v.uv);
    depths.emplace_back(v.puddle_depth_m / puddle_depth_unit_m, 0.0f);
    low = glm::min(low, v.position_m);
    high = glm::max(high, v.position_m);
    for (int c = 0; c < 3; ++c) {
      colours.push_back(static_cast<std::uint16_t>(std::clamp(v.colour[c], 0.0f, 1.0f) * 65535.0f + 0.5f));
    }
    colours.push_back(65535);
    coloured = coloured || v.colour != glm::vec3(1.0f);
    puddled = puddled || v.puddle_depth_m > no_puddle_m;
  }
  json attributes;
  const int position = w.floats(positions, "VEC3");
  w.root["accessors"][static_cast<std::size_t>(position)]["min"] = {low.x, low.y, low.z};
  w.root["accessors"][static_cast<std::size_t>(position)]["max"] = {high.x, high.y, high.z};
  attributes["POSITION"] = position;
  attributes["NORMAL"] = w.floats(normals, "VEC3");
  if (has_normal_map(mat)) attributes["TANGENT"] = w.floats(tangents(p), "VEC4");
  if (mat != Mat::glass) attributes["TEXCOORD_0"] = w.floats(uvs, "VEC2");
  if (coloured && mat != Mat::glow) {
    const int view = w.view(colours.data(), colours.size() * sizeof(std::uint16_t), target_vertices);
    attributes["COLOR_0"] = w.accessor(view, component_ushort, p.vertices.size(), "VEC4");
    w.root["accessors"].back()["normalized"] = true;
  }
  // An application-specific attribute, which a reader without water systems ignores.
  if (puddled) attributes["TEXCOORD_1"] = w.floats(depths, "VEC2");
  json out{{"attributes", attributes}, {"material", material}};
  if (p.vertices.size() < 65535) {
    std::vector<std::uint16_t> small(p.indices.begin(), p.indices.end());
    out["indices"] =
        w.accessor(w.view(small.data(), small.size() * 2, target_indices), component_ushort, small.size(), "SCALAR");
  } else {
    out["indices"] = w.accessor(w.view(p.indices.data(), p.indices.size() * 4, target_indices), component_uint,
                                p.indices.size(), "SCALAR");
  }
  return out;
}

void write_lights(json& root, const Scene& scene) {
  json lights = json::array();
  for (const Light& l : scene.lights) {
    json j{{"name", l.name},
           {"type", l.spot ? "spot" : "point"},
           {"intensity", l.intensity_cd},
           {"color", {l.colour.x, l.colour.y, l.colour.z}}};
    if (l.range_m > 0.0f) j["range"] = l.range_m;
    if (l.spot) j["spot"] = {{"innerConeAngle", l.inner_cone_rad}, {"outerConeAngle", l.outer_cone_rad}};
    lights.push_back(j);
  }
  if (!lights.empty()) root["extensions"]["KHR_lights_punctual"]["lights"] = lights;
}

void write_nodes(json& root, const Scene& scene) {
  json nodes = json::array();
  json roots = json::array();
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& n = scene.nodes[i];
    json j{{"name", n.name}};
    if (n.translation_m != glm::vec3(0.0f))
      j["translation"] = {n.translation_m.x, n.translation_m.y, n.translation_m.z};
    if (n.rotation != glm::quat(1, 0, 0, 0)) {
      const glm::quat q = glm::normalize(n.rotation);
      j["rotation"] = {q.x, q.y, q.z, q.w};
    }
    if (n.mesh >= 0) j["mesh"] = n.mesh;
    if (n.camera >= 0) j["camera"] = n.camera;
    if (n.light >= 0) j["extensions"]["KHR_lights_punctual"]["light"] = n.light;
    if (!n.extras_json.empty()) j["extras"] = json::parse(n.extras_json);
    nodes.push_back(j);
  }
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const int parent = scene.nodes[i].parent;
    if (parent < 0) {
      roots.push_back(i);
    } else {
      nodes[static_cast<std::size_t>(parent)]["children"].push_back(i);
    }
  }
  root["nodes"] = nodes;
  root["scenes"] = {{{"name", "city"}, {"nodes", roots}}};
  root["scene"] = 0;
}

void append_word(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (int k = 0; k < 4; ++k) out.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
}

}  // namespace

Result<std::vector<std::uint8_t>> glb_bytes(const Scene& scene, const WriteOptions& options) {
  Writer w;
  w.root["asset"] = {{"version", "2.0"}, {"generator", "petrichor_city"}};
  const MaterialSet materials = make_materials(scene, options.textures);
  for (const std::string& m : materials.json) w.root["materials"].push_back(json::parse(m));
  for (const EncodedImage& image : materials.images) {
    if (image.bytes.empty())
      return failure("petrichor_city: OpenImageIO could not encode " + image.name + " as " + image.mime_type);
    const std::size_t index = w.root["images"].size();
    w.root["images"].push_back({{"name", image.name},
                                {"mimeType", image.mime_type},
                                {"bufferView", w.view(image.bytes.data(), image.bytes.size(), 0)}});
    w.root["textures"].push_back({{"source", index}, {"sampler", 0}});
  }
  if (!materials.images.empty())
    w.root["samplers"] = {{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}}};
  for (const Mesh& mesh : scene.meshes) {
    json primitives = json::array();
    for (const auto& [mat, primitive] : mesh.primitives) {
      if (primitive.indices.empty()) continue;
      primitives.push_back(write_primitive(w, mat, primitive, materials.index_of[static_cast<std::size_t>(mat)]));
    }
    w.root["meshes"].push_back({{"name", mesh.name}, {"primitives", primitives}});
  }
  for (const Camera& c : scene.cameras) {
    w.root["cameras"].push_back(
        {{"name", c.name}, {"type", "perspective"}, {"perspective", {{"yfov", c.vertical_fov_rad}, {"znear", 0.05}}}});
  }
  write_lights(w.root, scene);
  write_nodes(w.root, scene);
  json used = json::array();
  if (!scene.lights.empty()) used.push_back("KHR_lights_punctual");
  if (options.textures) used.push_back("KHR_materials_emissive_strength");
  if (!used.empty()) w.root["extensionsUsed"] = used;
  w.bin.resize((w.bin.size() + 3) & ~std::size_t{3}, 0);
  w.root["buffers"] = {{{"byteLength", w.bin.size()}}};

  std::string text = w.root.dump();
  text.resize((text.size() + 3) & ~std::size_t{3}, ' ');
  std::vector<std::uint8_t> out;
  out.reserve(28 + text.size() + w.bin.size());
  append_word(out, 0x46546C67u);  // "glTF"
  append_word(out, 2);
  append_word(out, static_cast<std::uint32_t>(28 + text.size() + w.bin.size()));
  append_word(out, static_cast<std::uint32_t>(text.size()));
  append_word(out, 0x4E4F534Au);  // "JSON"
  out.insert(out.end(), text.begin(), text.end());
  append_word(out, static_cast<std::uint32_t>(w.bin.size()));
  append_word(out, 0x004E4942u);  // "BIN"
  out.insert(out.end(), w.bin.begin(), w.bin.end());
  return out;
}

Result<void> write_file(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  std::error_code ignored;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), ignored);
  // Written beside and renamed, so that a build that was stopped leaves no half file.
  std::filesystem::path part = path;
  part += ".part";
  std::ofstream file(part, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(part, path, error);
  if (!file || error)
    return failure("petrichor_city: cannot write " + path.string() + ": check the folder and the free space");
  return {};
}

}  // namespace petrichor::city
