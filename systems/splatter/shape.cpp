#include "systems/splatter/shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>

namespace petrichor {
namespace {

struct Face {
  std::array<std::uint32_t, 3> corners;
  glm::vec3 normal;  // unit
};

// One vertex for every tenth of a millimetre: meshes double theirs where normals or materials change.
struct Welder {
  std::map<std::tuple<std::int64_t, std::int64_t, std::int64_t>, std::uint32_t> known;
  std::uint32_t of(CatcherShape& s, const glm::vec3& p) {
    const auto key = std::tuple(std::llround(p.x * 1e4), std::llround(p.y * 1e4), std::llround(p.z * 1e4));
    const auto [at, fresh] = known.try_emplace(key, static_cast<std::uint32_t>(s.positions.size()));
    if (fresh) s.positions.push_back(p);
    return at->second;
  }
};

glm::vec2 cell_of(const CatcherShape& s, const glm::vec3& p) {
  const glm::vec3 size = glm::max(s.high_m - s.low_m, glm::vec3(1e-6f));
  return {(p.x - s.low_m.x) / size.x * catcher_cells, (p.z - s.low_m.z) / size.z * catcher_cells};
}

void draw_heights(CatcherShape& s, const Face& f) {
  const glm::vec3 &a = s.positions[f.corners[0]], &b = s.positions[f.corners[1]], &c = s.positions[f.corners[2]];
  const glm::vec2 pa = cell_of(s, a), pb = cell_of(s, b), pc = cell_of(s, c);
  const float area = (pb.x - pa.x) * (pc.y - pa.y) - (pb.y - pa.y) * (pc.x - pa.x);
  if (std::abs(area) < 1e-9f) return;
  const glm::vec2 low = glm::min(pa, glm::min(pb, pc)), high = glm::max(pa, glm::max(pb, pc));
  const int last = catcher_cells - 1;
  for (int z = std::clamp(int(low.y), 0, last); z <= std::clamp(int(high.y), 0, last); ++z)
    for (int x = std::clamp(int(low.x), 0, last); x <= std::clamp(int(high.x), 0, last); ++x) {
      const glm::vec2 p(x + 0.5f, z + 0.5f);
      const float wb = ((p.x - pa.x) * (pc.y - pa.y) - (p.y - pa.y) * (pc.x - pa.x)) / area;
      const float wc = ((pb.x - pa.x) * (p.y - pa.y) - (pb.y - pa.y) * (p.x - pa.x)) / area;
      if (wb < -1e-4f || wc < -1e-4f || wb + wc > 1.0001f) continue;
      glm::vec3& cell = s.heights[static_cast<std::size_t>(z * catcher_cells + x)];
      const float y = a.y + wb * (b.y - a.y) + wc * (c.y - a.y);
      if (cell.y > 0.0f && cell.x >= y) continue;
      cell = {y, 1.0f, thrown_up(f.normal.y)};
    }
}

// Cells that nothing covers take the heights of their neighbours, so that reading between cells does not fall off.
void spread_heights(CatcherShape& s) {
  std::vector<char> known(s.heights.size());
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = s.heights[i].y > 0.0f;
  for (int turn = 0; turn < 2; ++turn) {
    const std::vector<char> before = known;
    for (int z = 0; z < catcher_cells; ++z)
      for (int x = 0; x < catcher_cells; ++x) {
        const auto at = static_cast<std::size_t>(z * catcher_cells + x);
        if (before[at]) continue;
        float sum = 0.0f;
        int count = 0;
        for (int j = std::max(z - 1, 0); j <= std::min(z + 1, catcher_cells - 1); ++j)
          for (int i = std::max(x - 1, 0); i <= std::min(x + 1, catcher_cells - 1); ++i) {
            const auto from = static_cast<std::size_t>(j * catcher_cells + i);
            if (before[from]) sum += s.heights[from].x, ++count;
          }
        if (count) s.heights[at].x = sum / static_cast<float>(count), known[at] = 1;
      }
  }
}

struct Around {
  bool topmost;   // the rain's surface is no more than 3 cm above
  bool interior;  // surface at about the same height all round
};

// face: of the surface at p, whose plane tells what heights are "about the same".
Around around(const CatcherShape& s, const glm::vec3& p, const glm::vec3& face) {
  const glm::vec2 c = cell_of(s, p),
                  cell_m = glm::vec2(s.high_m.x - s.low_m.x, s.high_m.z - s.low_m.z) / float(catcher_cells);
  Around found{true, true};
  float highest = -1e30f;
  for (int j = -2; j <= 2; ++j)
    for (int i = -2; i <= 2; ++i) {
      const int x = int(std::floor(c.x)) + i, z = int(std::floor(c.y)) + j;
      const bool inside = x >= 0 && z >= 0 && x < catcher_cells && z < catcher_cells;
      const glm::vec2 cell = inside ? s.heights[static_cast<std::size_t>(z * catcher_cells + x)] : glm::vec2(0.0f);
      const float plane = p.y - (face.x * i * cell_m.x + face.z * j * cell_m.y) / std::max(face.y, 0.2f);
      if (cell.y <= 0.0f || std::abs(cell.x - plane) > 0.06f) found.interior = false;
      if (cell.y > 0.0f && std::abs(i) < 2 && std::abs(j) < 2) highest = std::max(highest, cell.x);
    }
  found.topmost = highest < p.y + 0.03f;
  return found;
}

void find_edges(CatcherShape& s, const std::vector<Face>& faces) {
  struct Sides {
    std::uint32_t first, second, count;
  };
  std::unordered_map<std::uint64_t, Sides> edges;
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = faces[f].corners[k], b = faces[f].corners[(k + 1) % 3];
      Sides& sides =
          edges.try_emplace(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), Sides{f, f, 0}).first->second;
      if (sides.count++ > 0) sides.second = f;
    }
  std::vector<std::pair<std::uint64_t, Sides>> sorted(edges.begin(), edges.end());
  std::sort(sorted.begin(), sorted.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  for (const auto& [key, sides] : sorted) {
    const auto a = static_cast<std::uint32_t>(key >> 32), b = static_cast<std::uint32_t>(key);
    const glm::vec3 first = faces[sides.first].normal;
    const bool open = sides.count == 1;
    const glm::vec3 second = open ? -first : faces[sides.second].normal;
    if (!open && glm::dot(first, second) > 0.99999f) continue;  // flat: never an outline
    if (std::max(first.y, second.y) < 0.05f) continue;          // rain strikes neither face
    const glm::vec3 struck = first.y >= second.y ? first : second;
    const Around where = around(s, 0.5f * (s.positions[a] + s.positions[b]), struck);
    // An open edge is an outline where a sheet ends, not where a patch lies on something.
    if (!where.topmost || (open && (where.interior || struck.y < 0.3f))) continue;
    s.edges.push_back({a, b, first, second});
  }
}

}  // namespace

CatcherShape make_shape(const Mesh& mesh) {
  CatcherShape s;
  Welder welder;
  std::vector<Face> faces;
  for (const Primitive& primitive : mesh.primitives)
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
      Face f{};
      for (std::size_t k = 0; k < 3; ++k)
        f.corners[k] = welder.of(s, primitive.vertices[primitive.indices[i + k]].position_m);
      const glm::vec3 n = glm::cross(s.positions[f.corners[1]] - s.positions[f.corners[0]],
                                     s.positions[f.corners[2]] - s.positions[f.corners[0]]);
      const float length = glm::length(n);
      if (!(length > 1e-10f)) continue;
      f.normal = n / length;
      faces.push_back(f);
    }
  if (faces.empty()) return s;
  s.low_m = s.high_m = s.positions.front();
  for (const glm::vec3& p : s.positions) s.low_m = glm::min(s.low_m, p), s.high_m = glm::max(s.high_m, p);
  s.normals.assign(s.positions.size(), glm::vec3(0.0f));
  s.heights.assign(std::size_t{catcher_cells} * catcher_cells, glm::vec3(0.0f));
  for (const Face& f : faces) {
    for (std::size_t k = 0; k < 3;
         ++k) {  // weighed by the angle there, so that a face's cut into triangles is the same
      const glm::vec3 at = s.positions[f.corners[k]];
      const glm::vec3 u = s.positions[f.corners[(k + 1) % 3]] - at, v = s.positions[f.corners[(k + 2) % 3]] - at;
      const float cosine = glm::dot(u, v) / std::max(glm::length(u) * glm::length(v), 1e-12f);
      s.normals[f.corners[k]] += f.normal * std::acos(std::clamp(cosine, -1.0f, 1.0f));
      s.indices.push_back(f.corners[k]);
    }
    draw_heights(s, f);
  }
  for (glm::vec3& n : s.normals) n = glm::length(n) > 1e-6f ? glm::normalize(n) : glm::vec3(0.0f, 1.0f, 0.0f);
  find_edges(s, faces);
  spread_heights(s);
  for (const Face& f : faces) {
    const glm::vec3 &a = s.positions[f.corners[0]], &b = s.positions[f.corners[1]], &c = s.positions[f.corners[2]];
    const glm::vec3 middle = (a + b + c) / 3.0f;
    const float level = 0.5f * glm::length(glm::cross(b - a, c - a)) * f.normal.y * thrown_up(f.normal.y);
    if (level > 0.0f && surface_at({&s, glm::vec3(1.0f)}, middle.x, middle.z).x < middle.y + 0.03f)
      s.upper.push_back({middle, f.normal, level});
  }
  return s;
}

glm::vec3 surface_at(const ScaledShape& scaled, float x_m, float z_m) {
  const CatcherShape& s = *scaled.shape;
  const glm::vec2 at = cell_of(s, {x_m / scaled.scale.x, 0.0f, z_m / scaled.scale.z}) - 0.5f;
  const glm::vec2 low = glm::floor(at), t = at - low;
  glm::vec3 sum(0.0f);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const int x = std::clamp(int(low.x) + i, 0, catcher_cells - 1),
                z = std::clamp(int(low.y) + j, 0, catcher_cells - 1);
      sum += s.heights[static_cast<std::size_t>(z * catcher_cells + x)] *
             ((i ? t.x : 1.0f - t.x) * (j ? t.y : 1.0f - t.y));
    }
  return {sum.x * scaled.scale.y, sum.y, sum.z};
}

float layer_depth(const ScaledShape& scaled, const glm::vec3& eye_m, const glm::vec3& way, float reach_m,
                  float extinction_per_m, float height_m, int steps) {
  const CatcherShape& s = *scaled.shape;
  const glm::vec3 a = s.low_m * scaled.scale, b = s.high_m * scaled.scale;
  const glm::vec3 low = glm::min(a, b), high = glm::max(a, b) + glm::vec3(0.0f, 8.0f * height_m, 0.0f);
  float enter = 0.0f, leave = reach_m;
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1.0f / (std::abs(way[axis]) > 1e-9f ? way[axis] : 1e-9f);
    const float t0 = (low[axis] - eye_m[axis]) * inverse, t1 = (high[axis] - eye_m[axis]) * inverse;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  if (!(leave > enter)) return 0.0f;
  const float ds = (leave - enter) / static_cast<float>(steps);
  float depth = 0.0f, last_height = 0.0f, last_cover = 0.0f;
  for (int i = 0; i <= steps; ++i) {
    const glm::vec3 p = eye_m + way * (enter + ds * static_cast<float>(i));
    const glm::vec3 surface = surface_at(scaled, p.x, p.z);
    const float height = (p.y - surface.x) / height_m;  // in units of the layer's
    if (i > 0) {
      // Of exp(-h) with h linear; below the surface there is none.
      const float h0 = std::max(last_height, 0.0f), h1 = std::max(height, 0.0f), dh = h1 - h0;
      const float e0 = std::exp(-h0), e1 = std::exp(-h1);
      float mean = std::abs(dh) > 1e-3f ? (e0 - e1) / dh : 0.5f * (e0 + e1);
      if (last_height > 0.0f && height < 0.0f)
        mean *= last_height / (last_height - height);
      else if (last_height < 0.0f && height > 0.0f)
        mean *= height / (height - last_height);
      else if (last_height < 0.0f && height < 0.0f)
        mean = 0.0f;
      depth += mean * 0.5f * (last_cover + surface.z) * ds;
    }
    if (i > 0 && height * height_m < -0.03f) break;  // well inside
    last_height = height;
    last_cover = surface.z;
  }
  return depth * extinction_per_m;
}

}  // namespace petrichor
