#include "systems/reflection/reflectors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

#include "systems/reflection/streak.h"

namespace petrichor {
namespace {

constexpr float dimmest_cd_m2 = 2.0f;  // a lit curtain; darker panels leave no streak
constexpr float longest_m = 4.0f;      // of a group of parts: longer ones stay apart
constexpr float gap_m = 0.3f;          // parts nearer than this are one thing

struct Part {  // triangles that hang together
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
  glm::vec3 flux{0.0f};    // radiance times area
  glm::vec3 normal{0.0f};  // times area
  float area = 0.0f;
  std::vector<glm::vec3> corners;
};

float to_linear(float c) {
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

float wrapped(float x, Wrap wrap) {
  if (wrap == Wrap::clamp) return std::clamp(x, 0.0f, 1.0f);
  const float whole = std::floor(x), part = x - whole;
  return wrap == Wrap::mirror && std::fmod(std::abs(whole), 2.0f) == 1.0f ? 1.0f - part : part;
}

// Colour textures are sRGB (glTF 2.0, 3.9).
glm::vec3 texel(const Model& model, const TextureUse& use, glm::vec2 uv) {
  if (use.image == no_index) return glm::vec3(1.0f);
  const Image& image = model.images[static_cast<std::size_t>(use.image)];
  if (image.width <= 0 || image.height <= 0) return glm::vec3(1.0f);
  const float c = std::cos(use.rotation_rad), s = std::sin(use.rotation_rad);
  uv *= use.scale;  // KHR_texture_transform: scale, then rotation, then offset
  uv = glm::vec2(c * uv.x + s * uv.y, -s * uv.x + c * uv.y) + use.offset;
  const int x =
      std::min(static_cast<int>(wrapped(uv.x, use.wrap_u) * static_cast<float>(image.width)), image.width - 1);
  const int y =
      std::min(static_cast<int>(wrapped(uv.y, use.wrap_v) * static_cast<float>(image.height)), image.height - 1);
  const std::size_t at =
      4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  if (image.is_float) return glm::vec3(1.0f);
  const auto channel = [&](std::size_t i) { return to_linear(static_cast<float>(image.pixels[at + i]) / 255.0f); };
  return {channel(0), channel(1), channel(2)};
}

std::size_t root(std::vector<std::size_t>& parent, std::size_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// Triangles that share corners, as parts.
std::vector<Part> parts_of(const Model& model, const Primitive& primitive, const Material& material) {
  std::map<std::tuple<int, int, int>, std::size_t> place;  // millimetres -> corner
  std::vector<std::size_t> corner(primitive.vertices.size());
  for (std::size_t i = 0; i < primitive.vertices.size(); ++i) {
    const glm::ivec3 mm(glm::round(primitive.vertices[i].position_m * 1000.0f));
    corner[i] = place.try_emplace({mm.x, mm.y, mm.z}, place.size()).first->second;
  }
  std::vector<std::size_t> parent(place.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto& index = primitive.indices;
  for (std::size_t t = 0; t + 2 < index.size(); t += 3)
    for (int k = 1; k < 3; ++k)
      parent[root(parent, corner[index[t + static_cast<std::size_t>(k)]])] = root(parent, corner[index[t]]);

  std::map<std::size_t, std::size_t> number;
  std::vector<Part> parts;
  for (std::size_t t = 0; t + 2 < index.size(); t += 3) {
    const Vertex &a = primitive.vertices[index[t]], &b = primitive.vertices[index[t + 1]],
                 &c = primitive.vertices[index[t + 2]];
    const auto [found, fresh] = number.try_emplace(root(parent, corner[index[t]]), parts.size());
    if (fresh) parts.emplace_back();
    Part& part = parts[found->second];
    const glm::vec3 twice = glm::cross(b.position_m - a.position_m, c.position_m - a.position_m);
    const float area = 0.5f * glm::length(twice);
    glm::vec3 colour(0.0f);
    constexpr int n = 6;  // a pattern of a window's frame and panes is met evenly enough
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n - i; ++j) {
        const float u = (static_cast<float>(i) + 0.33f) / n, v = (static_cast<float>(j) + 0.33f) / n;
        const auto& uv = material.emissive_texture.texcoord == 1 ? &Vertex::uv1 : &Vertex::uv0;
        colour += texel(model, material.emissive_texture, a.*uv * (1.0f - u - v) + b.*uv * u + c.*uv * v);
      }
    part.flux += material.emissive * colour * (area / (n * (n + 1) / 2));
    part.normal += 0.5f * twice;
    part.area += area;
    for (const Vertex* v : {&a, &b, &c}) {
      part.low = glm::min(part.low, v->position_m);
      part.high = glm::max(part.high, v->position_m);
      part.corners.push_back(v->position_m);
    }
  }
  return parts;
}

// Unites what almost touches, faces the same way and stays small.
std::vector<Part> grouped(std::vector<Part> parts) {
  std::erase_if(parts, [](const Part& p) {
    return p.area <= 0.0f || std::max({p.flux.x, p.flux.y, p.flux.z}) < dimmest_cd_m2 * p.area;
  });
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return std::tie(a.low.x, a.low.z, a.low.y) < std::tie(b.low.x, b.low.z, b.low.y);
  });
  std::vector<Part> groups;
  for (Part& part : parts) {
    Part* home = nullptr;
    for (Part& g : groups) {
      const glm::vec3 low = glm::min(g.low, part.low), high = glm::max(g.high, part.high);
      const bool touch =
          glm::all(glm::lessThan(part.low - gap_m, g.high)) && glm::all(glm::greaterThan(part.high + gap_m, g.low));
      const glm::vec3 mean_g = g.flux / g.area, mean_p = part.flux / part.area;
      const bool alike = glm::length(glm::normalize(mean_g) - glm::normalize(mean_p)) < 0.35f;
      if (touch && alike && glm::length(high - low) < longest_m) {
        home = &g;
        break;
      }
    }
    if (!home) {
      groups.push_back(std::move(part));
      continue;
    }
    home->low = glm::min(home->low, part.low);
    home->high = glm::max(home->high, part.high);
    home->flux += part.flux;
    home->normal += part.normal;
    home->area += part.area;
    home->corners.insert(home->corners.end(), part.corners.begin(), part.corners.end());
  }
  return groups;
}

Reflector reflector_of(const Part& part) {
  Reflector r;
  const float facing = glm::length(part.normal) / part.area;
  glm::vec3 normal = facing > 0.5f ? glm::normalize(part.normal) : glm::vec3(0, 0, 1);
  r.kind = facing > 0.5f ? ReflectorKind::panel : ReflectorKind::lantern;
  const glm::vec3 aside = std::abs(normal.y) > 0.9f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  const glm::vec3 across = glm::normalize(glm::cross(aside, normal)), up = glm::cross(normal, across);
  glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const glm::vec3& c : part.corners) {
    const glm::vec3 q(glm::dot(c, across), glm::dot(c, up), glm::dot(c, normal));
    low = glm::min(low, q), high = glm::max(high, q);
  }
  const glm::vec3 middle = 0.5f * (low + high);
  glm::vec2 half = 0.5f * glm::vec2(high - low);
  if (r.kind == ReflectorKind::lantern) half.x = 0.5f * (half.x + 0.5f * (high.z - low.z));
  half = glm::max(half, glm::vec2(0.01f));
  r.centre_m = across * middle.x + up * middle.y + normal * middle.z;
  r.half_across = across * half.x;
  r.half_up = up * half.y;
  // A closed convex body shows a quarter of its area to anybody (Cauchy); a sheet all of it.
  const float shown = r.kind == ReflectorKind::panel ? glm::length(part.normal) / part.area : 0.25f;
  r.radiance = part.flux * (shown / (4.0f * half.x * half.y));
  return r;
}

// A closed box much thinner than it is wide (a light box, a lit poster) shines to two sides; turned to whoever looks it
// would shine to all. Its large faces' normal, or none. A tube's normals point all round: two thirds of them to any
// side.
std::optional<glm::vec3> sheet_normal(const Part& part) {
  glm::vec3 largest(0.0f);
  for (std::size_t i = 0; i + 2 < part.corners.size(); i += 3) {
    const glm::vec3 n = glm::cross(part.corners[i + 1] - part.corners[i], part.corners[i + 2] - part.corners[i]);
    if (glm::dot(n, n) > glm::dot(largest, largest)) largest = n;
  }
  if (glm::dot(largest, largest) <= 0.0f) return {};
  const glm::vec3 axis = glm::normalize(largest);
  float along = 0.0f, all = 0.0f;
  for (std::size_t i = 0; i + 2 < part.corners.size(); i += 3) {
    const glm::vec3 n = glm::cross(part.corners[i + 1] - part.corners[i], part.corners[i + 2] - part.corners[i]);
    along += std::abs(glm::dot(n, axis)), all += glm::length(n);
  }
  return along > 0.75f * all ? std::optional(axis) : std::nullopt;
}

// Both sides of a sheet, each with the mean radiance of the whole.
void add_sheet(const Part& part, glm::vec3 normal, std::vector<Reflector>& found) {
  for (const float side : {1.0f, -1.0f}) {
    Part half;
    half.corners = part.corners;
    half.normal = normal * side;
    half.area = 1.0f;
    Reflector r = reflector_of(half);
    float depth = 0.0f;  // of the face before the middle
    for (const glm::vec3& c : part.corners) depth = std::max(depth, glm::dot(c - r.centre_m, normal * side));
    r.centre_m += normal * (side * depth);
    r.radiance = part.flux / part.area;
    found.push_back(r);
  }
}

// Taller than wide, and thin through most of its height: the width is that of its middle half of vertices.
std::optional<Reflector> post_of(const Model& model, const Mesh& mesh) {
  std::vector<glm::vec3> places;
  glm::vec3 colour(0.0f);
  for (const Primitive& p : mesh.primitives) {
    const bool known = p.material != no_index;
    const Material material = known ? model.materials[static_cast<std::size_t>(p.material)] : Material{};
    if (material.alpha_mode == AlphaMode::blend) return {};
    if (glm::length(material.emissive) > 0.0f) continue;
    for (const std::uint32_t i : p.indices) places.push_back(p.vertices[i].position_m);
    colour += glm::vec3(material.base_colour) * static_cast<float>(p.indices.size());
  }
  if (places.size() < 12) return {};
  colour /= static_cast<float>(places.size());
  glm::vec3 low = places.front(), high = low;
  for (const glm::vec3& p : places) low = glm::min(low, p), high = glm::max(high, p);
  const float tall = high.y - low.y, wide = std::max(high.x - low.x, high.z - low.z);
  if (tall < 0.6f || tall > 12.0f || wide > 0.45f * tall || wide > 1.6f) return {};
  const glm::vec3 foot(0.5f * (low.x + high.x), low.y, 0.5f * (low.z + high.z));
  std::vector<float> radius;
  for (const glm::vec3& p : places) radius.push_back(glm::length(glm::vec2(p.x - foot.x, p.z - foot.z)));
  std::nth_element(radius.begin(), radius.begin() + static_cast<std::ptrdiff_t>(radius.size() / 2), radius.end());
  Reflector post;
  post.kind = ReflectorKind::post;
  post.centre_m = foot + glm::vec3(0.0f, 0.5f * tall, 0.0f);
  post.half_up = {0.0f, 0.5f * tall, 0.0f};
  post.half_across = {std::max(radius[radius.size() / 2], 0.02f), 0.0f, 0.0f};
  post.radiance = glm::min(colour, glm::vec3(0.1f));  // a texture's mean is not known here; posts are dark
  return post;
}

}  // namespace

std::vector<Reflector> find_reflectors(const Model& model, const Mesh& mesh) {
  std::vector<Reflector> found;
  for (const Primitive& primitive : mesh.primitives) {
    if (primitive.material == no_index) continue;
    const Material& material = model.materials[static_cast<std::size_t>(primitive.material)];
    if (std::max({material.emissive.x, material.emissive.y, material.emissive.z}) < dimmest_cd_m2) continue;
    for (const Part& part : grouped(parts_of(model, primitive, material))) {
      const bool closed = glm::length(part.normal) <= 0.5f * part.area;
      const auto sheet = closed ? sheet_normal(part) : std::nullopt;
      if (sheet)
        add_sheet(part, *sheet, found);
      else
        found.push_back(reflector_of(part));
    }
  }
  if (const auto post = post_of(model, mesh)) found.push_back(*post);
  return found;
}

bool mirrors_things(const Model& model, const Mesh& mesh) {
  for (const Primitive& primitive : mesh.primitives) {
    if (primitive.material == no_index) continue;
    const Material& material = model.materials[static_cast<std::size_t>(primitive.material)];
    if (material.alpha_mode == AlphaMode::blend) continue;  // panes mirror by pass glass
    const TextureUse& use = material.metallic_roughness_texture;
    float least = 1.0f;
    if (use.image != no_index) {
      const Image& image = model.images[static_cast<std::size_t>(use.image)];
      const std::size_t texels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
      const std::size_t stride = std::max<std::size_t>(texels / 1024, 1);
      for (std::size_t i = 0; i < texels && !image.is_float; i += stride)
        least = std::min(least, static_cast<float>(image.pixels[4 * i + 1]) / 255.0f);  // green: glTF 2.0, 3.9.2
    }
    if (shading::mirror_share(least * material.roughness) > 0.0f) return true;
  }
  return false;
}

Reflector moved(const Reflector& r, const glm::mat4& m) {
  Reflector out = r;
  out.centre_m = glm::vec3(m * glm::vec4(r.centre_m, 1.0f));
  out.half_across = glm::mat3(m) * r.half_across;
  out.half_up = glm::mat3(m) * r.half_up;
  return out;
}

}  // namespace petrichor
