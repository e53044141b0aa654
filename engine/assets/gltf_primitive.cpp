// glTF primitives to indexed triangles (specification 2.0, section 3.7.2).

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "engine/assets/gltf_accessor.hpp"

namespace petrichor {
namespace {

// Caps of one model, far beyond any city that could be drawn: a small file can ask for much by naming the
// same accessor many times.
constexpr std::uint64_t maximum_vertices = 32u << 20;
constexpr std::uint64_t maximum_indices = 256u << 20;

struct Attributes {
  AccessorView position;
  std::optional<AccessorView> normal, tangent, uv0, uv1, colour;
};

struct Target {
  double weight = 0.0;
  std::optional<AccessorView> position, normal, tangent;
};

std::optional<AccessorView> open_attribute(Document& document, const std::map<std::string, int>& attributes,
                                           const std::string& name, std::uint64_t count, int fewest, int most,
                                           const std::string& path) {
  const auto found = attributes.find(name);
  if (found == attributes.end()) return std::nullopt;
  AccessorView view = open_accessor(document, found->second);
  const std::string at = fmt::format("{}/{}", path, name);
  if (view.components < fewest || view.components > most) {
    gltf_fail(at, fmt::format("{} has {} components, {} are needed", view.path, view.components,
                              fewest == most ? fmt::format("{}", fewest) : fmt::format("{} or {}", fewest, most)));
  }
  if (count != 0 && view.count != count) {
    gltf_fail(at, fmt::format("{} has {} elements, POSITION has {}", view.path, view.count, count));
  }
  return view;
}

std::vector<std::uint32_t> read_indices(Document& document, const tinygltf::Primitive& source,
                                        std::uint64_t vertex_count, const std::string& path) {
  const auto reserve = [&](std::uint64_t count) {
    document.index_count += count;
    if (document.index_count > maximum_indices)
      gltf_fail(path, fmt::format("the model passes {} indices", maximum_indices));
  };
  if (source.indices < 0) {
    reserve(vertex_count);
    std::vector<std::uint32_t> indices(vertex_count);
    std::iota(indices.begin(), indices.end(), 0u);
    return indices;
  }
  const AccessorView view = open_accessor(document, source.indices);
  if (view.components != 1) gltf_fail(path + "/indices", fmt::format("{} is no SCALAR", view.path));
  if (view.component_type != ComponentType::uint8 && view.component_type != ComponentType::uint16 &&
      view.component_type != ComponentType::uint32) {
    gltf_fail(view.path + "/componentType",
              fmt::format("{} holds indices: 5121, 5123 or 5125 is needed", static_cast<int>(view.component_type)));
  }
  reserve(view.count);
  std::vector<std::uint32_t> indices(view.count);
  for (std::uint64_t i = 0; i < view.count; ++i) {
    indices[i] = read_unsigned(view, i);
    if (indices[i] >= vertex_count) {
      gltf_fail(path + "/indices",
                fmt::format("entry {} of {} is {}, there are {} vertices", i, view.path, indices[i], vertex_count));
    }
  }
  return indices;
}

// Strips and fans keep the winding of section 3.7.2.1.
std::vector<std::uint32_t> unroll(Document& document, std::vector<std::uint32_t> in, int mode,
                                  const std::string& path) {
  const bool list = mode == TINYGLTF_MODE_TRIANGLES;
  if (in.size() < 3 || (list && in.size() % 3 != 0)) {
    document.warn(path, fmt::format("{} indices make no whole number of triangles; the rest is left out", in.size()));
  }
  if (in.size() < 3) return {};
  if (list) {
    in.resize(in.size() / 3 * 3);
    return in;
  }
  std::vector<std::uint32_t> out;
  out.reserve((in.size() - 2) * 3);
  for (std::size_t i = 0; i + 2 < in.size(); ++i) {
    const std::uint32_t a = mode == TINYGLTF_MODE_TRIANGLE_FAN ? in[i + 1] : in[i];
    const std::uint32_t b = mode == TINYGLTF_MODE_TRIANGLE_FAN ? in[i + 2] : in[i + 1 + i % 2];
    const std::uint32_t c = mode == TINYGLTF_MODE_TRIANGLE_FAN ? in[0] : in[i + 2 - i % 2];
    if (a == b || b == c || c == a) continue;  // stitches between strips
    out.insert(out.end(), {a, b, c});
  }
  return out;
}

// Renumbers so that only used vertices remain: exporters let many primitives share one large buffer.
// Returns the source vertex of each new one.
std::vector<std::uint32_t> compact(std::vector<std::uint32_t>& indices, std::uint64_t vertex_count) {
  std::vector<std::uint32_t> used;
  if (vertex_count <= 8 * indices.size()) {
    constexpr std::uint32_t unseen = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> renumbered(vertex_count, unseen);
    for (std::uint32_t i : indices) renumbered[i] = 0;
    for (std::uint32_t i = 0; i < vertex_count; ++i) {
      if (renumbered[i] == unseen) continue;
      renumbered[i] = static_cast<std::uint32_t>(used.size());
      used.push_back(i);
    }
    for (std::uint32_t& i : indices) i = renumbered[i];
    return used;
  }
  used = indices;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (std::uint32_t& i : indices) {
    i = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), i) - used.begin());
  }
  return used;
}

Vertex read_vertex(const Attributes& from, const std::vector<Target>& targets, std::uint32_t i) {
  Vertex v;
  v.position_m = read_vector(from.position, i);
  if (from.normal) v.normal = read_vector(*from.normal, i);
  if (from.tangent) v.tangent = read_vector(*from.tangent, i);
  if (from.uv0) v.uv0 = read_vector(*from.uv0, i);
  if (from.uv1) v.uv1 = read_vector(*from.uv1, i);
  if (from.colour) v.colour = read_vector(*from.colour, i);
  for (const Target& target : targets) {
    const auto weight = static_cast<float>(target.weight);
    if (target.position) v.position_m += weight * glm::vec3(read_vector(*target.position, i));
    if (target.normal) v.normal += weight * glm::vec3(read_vector(*target.normal, i));
    if (target.tangent) v.tangent += glm::vec4(weight * glm::vec3(read_vector(*target.tangent, i)), 0.0f);
  }
  for (int c = 0; c < 3; ++c) {
    if (!(std::abs(v.position_m[c]) <= largest_position_m)) {
      gltf_fail(from.position.path, fmt::format("element {} is {} from the origin, at most {} is read", i,
                                                v.position_m[c], largest_position_m));
    }
  }
  return v;
}

glm::dvec3 face_normal(const Primitive& p, std::size_t corner) {
  const glm::dvec3 a = p.vertices[p.indices[corner]].position_m;
  const glm::dvec3 b = p.vertices[p.indices[corner + 1]].position_m;
  const glm::dvec3 c = p.vertices[p.indices[corner + 2]].position_m;
  return glm::cross(b - a, c - a);  // length: twice the area
}

glm::vec3 unit_or(glm::dvec3 v, glm::vec3 otherwise) {
  const double length = glm::length(v);
  return length > 1e-30 ? glm::vec3(v / length) : otherwise;
}

// "When normals are not specified, client implementations MUST calculate flat normals" (section 3.7.2.1).
void set_flat_normals(Primitive& p) {
  for (std::size_t i = 0; i < p.indices.size(); i += 3) {
    const glm::vec3 normal = unit_or(face_normal(p, i), {0.0f, 1.0f, 0.0f});
    for (std::size_t k = 0; k < 3; ++k) p.vertices[p.indices[i + k]].normal = normal;
  }
}

// Normals to unit length; the few of no length get the mean of their faces.
void normalise_normals(Primitive& p) {
  bool any_missing = false;
  for (Vertex& v : p.vertices) {
    const double length = glm::length(glm::dvec3(v.normal));
    v.normal = length > 1e-12 ? glm::vec3(glm::dvec3(v.normal) / length) : glm::vec3(0.0f);
    any_missing = any_missing || !(length > 1e-12);
  }
  if (!any_missing) return;
  std::vector<glm::dvec3> sums(p.vertices.size(), glm::dvec3(0.0));
  for (std::size_t i = 0; i < p.indices.size(); i += 3) {
    const glm::dvec3 normal = face_normal(p, i);
    for (std::size_t k = 0; k < 3; ++k) sums[p.indices[i + k]] += normal;
  }
  for (std::size_t i = 0; i < p.vertices.size(); ++i) {
    if (p.vertices[i].normal == glm::vec3(0.0f)) p.vertices[i].normal = unit_or(sums[i], {0.0f, 1.0f, 0.0f});
  }
}

// Given tangents to unit length and a handedness of exactly one; false where one of them is useless.
bool normalise_tangents(Primitive& p) {
  for (Vertex& v : p.vertices) {
    const double length = glm::length(glm::dvec3(v.tangent));
    if (!(length > 1e-12)) return false;
    v.tangent = glm::vec4(glm::vec3(glm::dvec3(v.tangent) / length), v.tangent.w < 0.0f ? -1.0f : 1.0f);
  }
  return true;
}

std::vector<Target> open_targets(Document& document, const tinygltf::Primitive& source,
                                 const std::vector<double>& weights, std::uint64_t count, const std::string& path) {
  std::vector<Target> targets;
  for (std::size_t i = 0; i < source.targets.size() && i < weights.size(); ++i) {
    if (weights[i] == 0.0) continue;
    const std::string at = fmt::format("{}/targets/{}", path, i);
    Target target;
    target.weight = weights[i];
    target.position = open_attribute(document, source.targets[i], "POSITION", count, 3, 3, at);
    target.normal = open_attribute(document, source.targets[i], "NORMAL", count, 3, 3, at);
    target.tangent = open_attribute(document, source.targets[i], "TANGENT", count, 3, 3, at);
    targets.push_back(std::move(target));
  }
  return targets;
}

std::optional<Primitive> convert_primitive(Document& document, const Model& model, const tinygltf::Primitive& source,
                                           const std::vector<double>& weights, const SkinPose* pose,
                                           const std::string& path) {
  if (source.mode < TINYGLTF_MODE_TRIANGLES) {
    document.warn(path + "/mode", fmt::format("mode {} (points or lines) is left out", source.mode));
    return std::nullopt;
  }
  const std::string attributes_path = path + "/attributes";
  auto position = open_attribute(document, source.attributes, "POSITION", 0, 3, 3, attributes_path);
  if (!position) {
    document.warn(attributes_path, "without POSITION there is nothing to draw");
    return std::nullopt;
  }
  Attributes from{std::move(*position), {}, {}, {}, {}, {}};
  const std::uint64_t count = from.position.count;
  if (count > std::numeric_limits<std::uint32_t>::max())
    gltf_fail(from.position.path + "/count", "more vertices than indices can name");
  from.normal = open_attribute(document, source.attributes, "NORMAL", count, 3, 3, attributes_path);
  from.tangent = open_attribute(document, source.attributes, "TANGENT", count, 4, 4, attributes_path);
  from.uv0 = open_attribute(document, source.attributes, "TEXCOORD_0", count, 2, 2, attributes_path);
  from.uv1 = open_attribute(document, source.attributes, "TEXCOORD_1", count, 2, 2, attributes_path);
  from.colour = open_attribute(document, source.attributes, "COLOR_0", count, 3, 4, attributes_path);
  const auto targets = open_targets(document, source, weights, count, path);

  Primitive out;
  out.material = source.material;
  out.indices = unroll(document, read_indices(document, source, count, path), source.mode, path);
  if (out.indices.empty()) return std::nullopt;
  std::vector<std::uint32_t> used;
  if (from.normal) {
    used = compact(out.indices, count);
  } else {
    used.swap(out.indices);  // flat normals: no two triangles share a vertex
    out.indices.resize(used.size());
    std::iota(out.indices.begin(), out.indices.end(), 0u);
  }
  document.vertex_count += used.size();
  if (document.vertex_count > maximum_vertices)
    gltf_fail(path, fmt::format("the model passes {} vertices", maximum_vertices));
  out.vertices.reserve(used.size());
  for (std::uint32_t i : used) out.vertices.push_back(read_vertex(from, targets, i));
  if (pose) apply_pose(document, source, used, *pose, out, path);

  if (from.normal)
    normalise_normals(out);
  else
    set_flat_normals(out);
  const Material* material = out.material >= 0 ? &model.materials[static_cast<std::size_t>(out.material)] : nullptr;
  const bool normal_mapped = material && material->normal_texture.image != no_index;
  // Tangents without normals are to be ignored (section 3.7.2.1).
  if (!from.normal || !from.tangent || !normalise_tangents(out)) {
    compute_tangents(out, normal_mapped && material->normal_texture.texcoord == 1, normal_mapped);
  }
  out.bounds_min_m = out.bounds_max_m = out.vertices.front().position_m;
  for (const Vertex& v : out.vertices) {
    out.bounds_min_m = glm::min(out.bounds_min_m, v.position_m);
    out.bounds_max_m = glm::max(out.bounds_max_m, v.position_m);
  }
  return out;
}

}  // namespace

Mesh convert_mesh(Document& document, const Model& model, int mesh_index, const std::vector<double>& weights,
                  const SkinPose* pose) {
  const tinygltf::Mesh& source = document.gltf->meshes[static_cast<std::size_t>(mesh_index)];
  Mesh mesh;
  mesh.name = source.name;
  for (std::size_t i = 0; i < source.primitives.size(); ++i) {
    const std::string path = fmt::format("/meshes/{}/primitives/{}", mesh_index, i);
    if (auto primitive = convert_primitive(document, model, source.primitives[i], weights, pose, path)) {
      mesh.primitives.push_back(std::move(*primitive));
    }
  }
  return mesh;
}

}  // namespace petrichor
