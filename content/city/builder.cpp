#include "content/city/builder.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace petrichor::city {
namespace {

constexpr float tau = 6.283185307f;
constexpr float smallest_double_area_m2 = 2e-8f;

glm::vec2 palette_cell(int index) {
  return {(static_cast<float>(index % 8) + 0.5f) / 8.0f, (static_cast<float>(index / 8) + 0.5f) / 8.0f};
}

bool is_flat(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  return glm::length(glm::cross(b - a, c - a)) < smallest_double_area_m2;
}

// Texture axes of a plane in the local frame: u horizontal, v up (or along -z on level ground).
glm::vec2 plane_uv(glm::vec3 p, glm::vec3 normal) {
  const glm::vec3 n = glm::abs(normal);
  if (n.y > 0.85f) return {p.x, -p.z};
  const glm::vec3 u = glm::normalize(glm::cross(glm::vec3(0, 1, 0), normal));
  const glm::vec3 v = glm::cross(normal, u);
  return {glm::dot(p, u), glm::dot(p, v)};
}

bool uses_palette(Mat mat) {
  return mat == Mat::plain || mat == Mat::glow;
}

glm::vec3 perpendicular(glm::vec3 direction) {
  const glm::vec3 helper = std::abs(direction.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  return glm::normalize(glm::cross(direction, helper));
}

}  // namespace

Paint plain(glm::vec3 colour, Finish finish) {
  return {Mat::plain, colour, palette_cell(static_cast<int>(finish))};
}
Paint glow(Glow colour) {
  return {Mat::glow, glm::vec3(1.0f), palette_cell(static_cast<int>(colour))};
}
Paint tiling(Mat mat, glm::vec3 tint, glm::vec2 offset_m) {
  return {mat, tint, offset_m};
}

Builder::Builder(Mesh& mesh, const glm::mat4& frame) : mesh_(&mesh), frame_(frame), turn_(glm::mat3(frame)) {}

Builder Builder::moved(glm::vec3 offset_m, float turn_y_rad) const {
  return at(glm::rotate(glm::translate(glm::mat4(1.0f), offset_m), turn_y_rad, glm::vec3(0, 1, 0)));
}

std::uint32_t Builder::put(Primitive& out, const Paint& paint, glm::vec3 position, glm::vec3 normal, glm::vec2 uv_m) {
  Vertex v{};
  v.position_m = glm::vec3(frame_ * glm::vec4(position, 1.0f));
  v.normal = glm::normalize(turn_ * normal);
  v.uv = uses_palette(paint.mat) ? paint.uv : (uv_m + paint.uv) / texture_metres(paint.mat) * glm::vec2(1, -1);
  v.colour = glm::clamp(paint.colour, 0.0f, 1.0f);  // an albedo
  out.vertices.push_back(v);
  return static_cast<std::uint32_t>(out.vertices.size()) - 1;
}

void Builder::quad(const Paint& paint, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  const bool first = !is_flat(a, b, c);
  const bool second = !is_flat(a, c, d);
  if (!first && !second) return;
  const glm::vec3 n = glm::normalize(first ? glm::cross(b - a, c - a) : glm::cross(c - a, d - a));
  Primitive& out = primitive(paint.mat);
  const std::uint32_t i = put(out, paint, a, n, plane_uv(a, n));
  put(out, paint, b, n, plane_uv(b, n));
  put(out, paint, c, n, plane_uv(c, n));
  put(out, paint, d, n, plane_uv(d, n));
  if (first) out.indices.insert(out.indices.end(), {i, i + 1, i + 2});
  if (second) out.indices.insert(out.indices.end(), {i, i + 2, i + 3});
}

void Builder::triangle(const Paint& paint, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  const glm::vec3 points[] = {a, b, c};
  fan(paint, points);
}

void Builder::fan(const Paint& paint, std::span<const glm::vec3> convex) {
  glm::vec3 n(0.0f);
  for (std::size_t k = 2; k < convex.size(); ++k) {
    n += glm::cross(convex[k - 1] - convex[0], convex[k] - convex[0]);
  }
  if (glm::length(n) < smallest_double_area_m2) return;
  n = glm::normalize(n);
  Primitive& out = primitive(paint.mat);
  const auto base = static_cast<std::uint32_t>(out.vertices.size());
  for (const glm::vec3& p : convex) put(out, paint, p, n, plane_uv(p, n));
  for (std::uint32_t k = 2; k < convex.size(); ++k) {
    if (is_flat(convex[0], convex[k - 1], convex[k])) continue;
    out.indices.insert(out.indices.end(), {base, base + k - 1, base + k});
  }
}

void Builder::picture(Mat mat, glm::vec3 tint, UvRect rect, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  if (is_flat(a, b, c) || is_flat(a, c, d)) return;
  const glm::vec3 n = glm::normalize(glm::cross(b - a, c - a));
  const Paint paint{mat, tint, glm::vec2(0.0f)};
  Primitive& out = primitive(mat);
  const std::uint32_t i = put(out, paint, a, n, {});
  put(out, paint, b, n, {});
  put(out, paint, c, n, {});
  put(out, paint, d, n, {});
  out.vertices[i].uv = {rect.minimum.x, rect.maximum.y};
  out.vertices[i + 1].uv = {rect.maximum.x, rect.maximum.y};
  out.vertices[i + 2].uv = {rect.maximum.x, rect.minimum.y};
  out.vertices[i + 3].uv = {rect.minimum.x, rect.minimum.y};
  out.indices.insert(out.indices.end(), {i, i + 1, i + 2, i, i + 2, i + 3});
}

void Builder::box(const Paint& paint, glm::vec3 l, glm::vec3 h, unsigned faces) {
  if (faces & face_front) quad(paint, {l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z});
  if (faces & face_back) quad(paint, {h.x, l.y, l.z}, {l.x, l.y, l.z}, {l.x, h.y, l.z}, {h.x, h.y, l.z});
  if (faces & face_left) quad(paint, {l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, {l.x, h.y, l.z});
  if (faces & face_right) quad(paint, {h.x, l.y, h.z}, {h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z});
  if (faces & face_top) quad(paint, {l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z}, {l.x, h.y, l.z});
  if (faces & face_bottom) quad(paint, {l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z});
}

void Builder::moulding(const Paint& paint, std::span<const glm::vec2> profile, float x0, float x1, float miter0,
                       float miter1, bool caps) {
  for (std::size_t k = 1; k < profile.size(); ++k) {
    const glm::vec2 p = profile[k - 1];
    const glm::vec2 q = profile[k];
    quad(paint, {x0 - p.x * miter0, p.y, p.x}, {x1 + p.x * miter1, p.y, p.x}, {x1 + q.x * miter1, q.y, q.x},
         {x0 - q.x * miter0, q.y, q.x});
  }
  if (!caps) return;
  // Star-shaped from a point on the wall, which every profile of a cornice is; mitred ends meet a neighbour.
  float middle = 0.0f;
  for (const glm::vec2& p : profile) middle += p.y / static_cast<float>(profile.size());
  for (std::size_t k = 1; k < profile.size(); ++k) {
    const glm::vec2 p = profile[k - 1];
    const glm::vec2 q = profile[k];
    if (miter0 == 0.0f) triangle(paint, {x0, middle, 0.0f}, {x0, p.y, p.x}, {x0, q.y, q.x});
    if (miter1 == 0.0f) triangle(paint, {x1, middle, 0.0f}, {x1, q.y, q.x}, {x1, p.y, p.x});
  }
}

void Builder::cylinder(const Paint& paint, glm::vec3 a, glm::vec3 b, float ra, float rb, int sides, bool cap_a,
                       bool cap_b) {
  const glm::vec3 axis = glm::normalize(b - a);
  const glm::vec3 x = perpendicular(axis);
  const glm::vec3 y = glm::cross(axis, x);
  Primitive& out = primitive(paint.mat);
  const auto base = static_cast<std::uint32_t>(out.vertices.size());
  const float lean = (ra - rb) / glm::length(b - a);
  for (int k = 0; k <= sides; ++k) {
    const float t = tau * static_cast<float>(k) / static_cast<float>(sides);
    const glm::vec3 d = x * std::cos(t) + y * std::sin(t);
    const glm::vec3 n = glm::normalize(d + axis * lean);
    const float u = t * std::max(ra, rb);
    put(out, paint, a + d * ra, n, {u, 0.0f});
    put(out, paint, b + d * rb, n, {u, glm::length(b - a)});
  }
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(sides); ++k) {
    const std::uint32_t i = base + 2 * k;
    if (ra > 0.0f) out.indices.insert(out.indices.end(), {i, i + 2, i + 1});
    if (rb > 0.0f) out.indices.insert(out.indices.end(), {i + 1, i + 2, i + 3});
  }
  std::vector<glm::vec3> ring(static_cast<std::size_t>(sides));
  const auto cap = [&](glm::vec3 centre, float r, bool at_b) {
    for (int k = 0; k < sides; ++k) {
      const float t = tau * static_cast<float>(at_b ? k : sides - k) / static_cast<float>(sides);
      ring[static_cast<std::size_t>(k)] = centre + (x * std::cos(t) + y * std::sin(t)) * r;
    }
    fan(paint, ring);
  };
  if (cap_a && ra > 0.0f) cap(a, ra, false);
  if (cap_b && rb > 0.0f) cap(b, rb, true);
}

void Builder::tube(const Paint& paint, std::span<const glm::vec3> path, float radius_m, int sides, bool closed) {
  const std::size_t n = path.size();
  if (n < 2) return;
  Primitive& out = primitive(paint.mat);
  const auto base = static_cast<std::uint32_t>(out.vertices.size());
  glm::vec3 x(0.0f);
  const std::size_t rings = closed ? n + 1 : n;
  for (std::size_t i = 0; i < rings; ++i) {
    const glm::vec3 here = path[i % n];
    const glm::vec3 before = closed ? path[(i + n - 1) % n] : path[i == 0 ? 0 : i - 1];
    const glm::vec3 after = closed ? path[(i + 1) % n] : path[std::min(i + 1, n - 1)];
    const glm::vec3 axis = glm::normalize(after - before);
    // Parallel transport: keep the last ring's direction, made square to the new axis.
    x = i == 0 ? perpendicular(axis) : glm::normalize(x - axis * glm::dot(x, axis));
    const glm::vec3 y = glm::cross(axis, x);
    for (int k = 0; k <= sides; ++k) {
      const float t = tau * static_cast<float>(k) / static_cast<float>(sides);
      const glm::vec3 d = x * std::cos(t) + y * std::sin(t);
      put(out, paint, here + d * radius_m, d, {t * radius_m, static_cast<float>(i)});
    }
  }
  const auto stride = static_cast<std::uint32_t>(sides + 1);
  for (std::uint32_t i = 0; i + 1 < rings; ++i) {
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(sides); ++k) {
      const std::uint32_t a = base + i * stride + k;
      out.indices.insert(out.indices.end(), {a, a + 1, a + stride, a + 1, a + stride + 1, a + stride});
    }
  }
}

void Builder::lathe(const Paint& paint, std::span<const glm::vec2> profile, int sides) {
  for (std::size_t k = 1; k < profile.size(); ++k) {
    const glm::vec2 top = profile[k - 1];
    const glm::vec2 low = profile[k];
    if (std::abs(top.y - low.y) < 1e-5f) {  // a level ring: one quad a side
      for (int s = 0; s < sides; ++s) {
        const float t0 = tau * static_cast<float>(s) / static_cast<float>(sides);
        const float t1 = tau * static_cast<float>(s + 1) / static_cast<float>(sides);
        const auto on = [&](float r, float t) { return glm::vec3(r * std::sin(t), top.y, r * std::cos(t)); };
        quad(paint, on(low.x, t0), on(low.x, t1), on(top.x, t1), on(top.x, t0));
      }
    } else {
      cylinder(paint, {0.0f, low.y, 0.0f}, {0.0f, top.y, 0.0f}, low.x, top.x, sides);
    }
  }
}

void Builder::surface(const Paint& paint, int nu, int nv, const Surface& position) {
  Primitive& out = primitive(paint.mat);
  const auto base = static_cast<std::uint32_t>(out.vertices.size());
  const float eps = 1e-3f;
  std::vector<glm::vec3> points;
  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(nu);
      const float v = static_cast<float>(j) / static_cast<float>(nv);
      const glm::vec3 p = position(u, v);
      glm::vec3 du = position(std::min(u + eps, 1.0f), v) - position(std::max(u - eps, 0.0f), v);
      glm::vec3 dv = position(u, std::min(v + eps, 1.0f)) - position(u, std::max(v - eps, 0.0f));
      // At a pole one derivative vanishes: step inside.
      if (glm::length(du) < 1e-7f) {
        const float w = v < 0.5f ? v + 0.01f : v - 0.01f;
        du = position(std::min(u + eps, 1.0f), w) - position(std::max(u - eps, 0.0f), w);
      }
      if (glm::length(dv) < 1e-7f) {
        const float w = u < 0.5f ? u + 0.01f : u - 0.01f;
        dv = position(w, std::min(v + eps, 1.0f)) - position(w, std::max(v - eps, 0.0f));
      }
      glm::vec3 n = glm::cross(du, dv);
      n = glm::length(n) > 1e-12f ? glm::normalize(n) : glm::vec3(0, 1, 0);
      put(out, paint, p, n, plane_uv(p, n));
      points.push_back(p);
    }
  }
  const auto stride = static_cast<std::uint32_t>(nu + 1);
  const auto emit = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (!is_flat(points[a], points[b], points[c])) {
      out.indices.insert(out.indices.end(), {base + a, base + b, base + c});
    }
  };
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(nv); ++j) {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(nu); ++i) {
      const std::uint32_t a = j * stride + i;
      emit(a, a + 1, a + stride + 1);
      emit(a, a + stride + 1, a + stride);
    }
  }
}

void Builder::vertex_triangle(Mat mat, const Vertex& a, const Vertex& b, const Vertex& c) {
  if (is_flat(a.position_m, b.position_m, c.position_m)) return;
  Primitive& out = primitive(mat);
  for (Vertex v : {a, b, c}) {
    v.position_m = glm::vec3(frame_ * glm::vec4(v.position_m, 1.0f));
    v.normal = glm::normalize(turn_ * v.normal);
    out.indices.push_back(static_cast<std::uint32_t>(out.vertices.size()));
    out.vertices.push_back(v);
  }
}

glm::mat4 wall_frame(glm::vec3 origin, glm::vec3 out) {
  const glm::vec3 z = glm::normalize(out);
  const glm::vec3 y(0, 1, 0);
  const glm::vec3 x = glm::cross(y, z);
  return {glm::vec4(x, 0), glm::vec4(y, 0), glm::vec4(z, 0), glm::vec4(origin, 1)};
}

}  // namespace petrichor::city
