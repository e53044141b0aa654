#include "systems/splatter/placed.hpp"

#include <algorithm>
#include <cmath>

#include "systems/frame_gpu.hpp"
#include "systems/frustum.hpp"
#include "systems/splatter/mist.hpp"

namespace petrichor {
namespace {

constexpr float outline_width = 0.12f;     // cosine over which a fin comes and goes
constexpr float most_gathered = 4.0f;
// A ray that goes below the object's own surface within this past an edge shows that surface: no outline, but a seam.
constexpr float seam_m = 0.35f;

// The lamps that light droplets there most.
void choose_lamps(const std::vector<LightGpu>& lights, const glm::vec3& middle, float radius, int most,
                  CatcherGpu& gpu) {
  std::vector<std::pair<float, std::uint32_t>> weights;
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    const LightGpu& l = lights[i];
    if (l.cone_shadow.w == 0.0f) continue;
    const float strongest = std::max({l.intensity_radius.x, l.intensity_radius.y, l.intensity_radius.z});
    if (l.direction_kind.w == float(LIGHT_DIRECTIONAL)) {
      weights.emplace_back(strongest, i);
      continue;
    }
    const glm::vec3 to = middle - glm::vec3(l.position_range);
    const float away = std::max(glm::length(to) - radius, 0.3f);
    if (away > l.position_range.w) continue;
    if (l.direction_kind.w == float(LIGHT_SPOT)) {
      const float angle = std::asin(std::min(radius / std::max(glm::length(to), 1e-3f), 1.0f));
      const float off = std::acos(
          std::clamp(glm::dot(to, glm::vec3(l.direction_kind)) / std::max(glm::length(to), 1e-3f), -1.0f, 1.0f));
      if (std::cos(std::max(off - angle, 0.0f)) * l.cone_shadow.x + l.cone_shadow.y <= 0.0f) continue;
    }
    weights.emplace_back(strongest / (away * away), i);
  }
  std::sort(weights.begin(), weights.end(),
            [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
  const auto count = std::min<std::size_t>(weights.size(), static_cast<std::size_t>(std::min(most, SPLATTER_LAMPS)));
  for (std::size_t i = 0; i < count; ++i) gpu.lamps[i / 4][static_cast<int>(i % 4)] = weights[i].second;
  gpu.key.z = static_cast<std::uint32_t>(count);
}

// Pixels that a box may touch; false: none.
bool pixels_of(const glm::mat4& relative_from_local, const glm::vec3& low, const glm::vec3& high, const Frame& frame,
               int width, int height, glm::ivec2& first, glm::ivec2& last) {
  glm::vec2 from(1.0f), to(-1.0f);
  bool crosses = false;
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 corner((i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y, (i & 4) ? high.z : low.z);
    const glm::vec4 clip = frame.uniforms.view_projection * (relative_from_local * glm::vec4(corner, 1.0f));
    if (clip.w < frame.camera.near_m) {
      crosses = true;
      continue;
    }
    from = glm::min(from, glm::vec2(clip) / clip.w);
    to = glm::max(to, glm::vec2(clip) / clip.w);
  }
  if (crosses) from = glm::vec2(-1.0f), to = glm::vec2(1.0f);
  const glm::vec2 size(width, height);
  first = glm::max(glm::ivec2(glm::floor((glm::clamp(from, -1.0f, 1.0f) * 0.5f + 0.5f) * size)), glm::ivec2(0));
  last = glm::min(glm::ivec2(glm::ceil((glm::clamp(to, -1.0f, 1.0f) * 0.5f + 0.5f) * size)),
                  glm::ivec2(width - 1, height - 1));
  return first.x <= last.x && first.y <= last.y;
}

}  // namespace

KeptShape& kept_shape(ShapeStore& store, const std::shared_ptr<const Mesh>& mesh) {
  const auto [at, fresh] = store.try_emplace(mesh.get());
  if (fresh) {
    at->second.mesh = mesh;
    at->second.shape = make_shape(*mesh);
  }
  return at->second;
}

bool any_catcher_in_view(ShapeStore& store, const Frame& frame, float feature_m, float margin_m) {
  if (!frame.splatter) return false;
  const Frustum frustum = frustum_of(frame.uniforms.view_projection);
  return std::any_of(frame.splatter->catchers.begin(), frame.splatter->catchers.end(), [&](const Catcher& c) {
    const glm::mat4& m = frame.instances[c.instance].matrix;
    const CatcherShape& shape = kept_shape(store, c.mesh).shape;
    if (shape.positions.empty()) return false;
    const glm::mat3 linear(m), absolute(glm::abs(linear[0]), glm::abs(linear[1]), glm::abs(linear[2]));
    const glm::vec3 middle = linear * (0.5f * (shape.low_m + shape.high_m)) +
                             glm::vec3(glm::dvec3(m[3]) - frame.camera.position_m);
    const glm::vec3 half = absolute * (0.5f * (shape.high_m - shape.low_m)) + glm::vec3(0.01f + margin_m);
    const float away = glm::length(glm::max(glm::abs(middle) - half, glm::vec3(0.0f)));
    return feature_m * frame.uniforms.lens.z >= 0.01f * away && box_touches(frustum, middle, half);
  });
}

std::vector<PlacedCatcher> place_catchers(ShapeStore& store, const Frame& frame, int width, int height, float feature_m,
                                          float least_px, float margin_m, int lamps, std::size_t most) {
  std::vector<PlacedCatcher> placed;
  if (!frame.splatter) return placed;
  const FrameSplatter& all = *frame.splatter;
  const Frustum frustum = frustum_of(frame.uniforms.view_projection);
  for (const Catcher& c : all.catchers) {
    const FrameInstance& in = frame.instances[c.instance];
    PlacedCatcher p{};
    p.catcher = &c;
    p.relative_from_object = in.matrix;
    p.relative_from_object[3] = glm::vec4(glm::vec3(glm::dvec3(in.matrix[3]) - frame.camera.position_m), 1.0f);
    const glm::mat3 linear(in.matrix);
    p.scale = {glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])};
    if (!(std::min({p.scale.x, p.scale.y, p.scale.z}) > 1e-6f)) continue;
    const glm::mat3 axes(linear[0] / p.scale.x, linear[1] / p.scale.y, linear[2] / p.scale.z);
    p.kept = &kept_shape(store, c.mesh);
    const CatcherShape& shape = p.kept->shape;
    if (shape.positions.empty()) continue;
    const glm::vec3 low = shape.low_m * p.scale - glm::vec3(0.01f),
                    high = shape.high_m * p.scale + glm::vec3(0.01f, margin_m, 0.01f);
    const glm::mat3 turned = glm::transpose(axes);
    const glm::vec3 eye = -(turned * glm::vec3(p.relative_from_object[3]));
    p.distance_m = glm::length(glm::max(glm::max(low - eye, eye - high), glm::vec3(0.0f)));
    if (feature_m * frame.uniforms.lens.z < least_px * p.distance_m) continue;
    const glm::vec3 middle = glm::vec3(p.relative_from_object * glm::vec4(0.5f * (shape.low_m + shape.high_m), 1.0f));
    const glm::vec3 half = 0.5f * (high - low);
    const glm::mat3 absolute(glm::abs(axes[0]), glm::abs(axes[1]), glm::abs(axes[2]));
    if (!box_touches(frustum, middle, absolute * half + glm::vec3(0.0f, margin_m, 0.0f))) continue;

    glm::mat4 local(turned);
    local[3] = glm::vec4(eye, 1.0f);
    const glm::mat4 relative_from_local = glm::mat4(glm::vec4(axes[0], 0.0f), glm::vec4(axes[1], 0.0f),
                                                    glm::vec4(axes[2], 0.0f), p.relative_from_object[3]);
    if (!pixels_of(relative_from_local, low, high, frame, width, height, p.first_pixel, p.last_pixel)) continue;
    const SplashMist& mist = all.mist;
    p.gpu.local_from_relative = local;
    p.gpu.low = glm::vec4(shape.low_m * p.scale, p.scale.y);
    p.gpu.high = glm::vec4(shape.high_m * p.scale, axes[1].y > 0.5f ? 1.0f : 0.0f);
    p.gpu.mist = {mist.extinction_per_m * c.halo, mist.height_m * c.halo_height, 1e-3f * mist.droplet_mm,
                  mist.speed_mps};
    p.gpu.crown = {mist.crowns_per_m2_s, 1e-3f * mist.crown_mm, mist.crown_speed_mps, 0.0f};
    p.gpu.shells = {static_cast<float>(std::clamp(c.shells, 1, SPLATTER_SHELLS)), c.shell_height_m, c.splatter, 1.0f};
    p.gpu.key = {c.key, frame.rain ? frame.rain->seed : 0u, 0u, c.published ? 1u : 0u};
    placed.push_back(p);
  }
  std::sort(placed.begin(), placed.end(), [](const PlacedCatcher& a, const PlacedCatcher& b) {
    return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.catcher->instance < b.catcher->instance;
  });
  if (placed.size() > most) placed.resize(most);
  if (placed.empty()) return placed;
  const std::vector<LightGpu> lights = visible_lights(frame);
  for (PlacedCatcher& p : placed) {
    const CatcherShape& shape = p.kept->shape;
    const glm::vec3 middle = glm::vec3(p.relative_from_object * glm::vec4(0.5f * (shape.low_m + shape.high_m), 1.0f));
    choose_lamps(lights, middle, 0.5f * glm::length((shape.high_m - shape.low_m) * p.scale), lamps, p.gpu);
  }
  return placed;
}

float thrown_sections(const SplashMist& mist) {
  return static_cast<float>(splash_of(mist.crown_mm, mist.crown_speed_mps).droplets * crown_section);
}

float outline_share(float cosine_a, float cosine_b, float width) {
  const auto towards = [&](float c) {
    if (width <= 0.0f) return c > 0.0f ? 1.0f : 0.0f;
    const float t = std::clamp(0.5f + 0.5f * c / width, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
  };
  return std::abs(towards(cosine_a) - towards(cosine_b));
}

void append_fins(const PlacedCatcher& p, const Frame&, int steps, std::vector<FinGpu>& fins) {
  const CatcherShape& shape = p.kept->shape;
  const ScaledShape scaled{&shape, p.scale};
  const glm::mat3 linear(p.relative_from_object);
  const float mirrored = glm::determinant(linear) < 0.0f ? -1.0f : 1.0f;
  const glm::mat3 turn =
      glm::mat3(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]), glm::cross(linear[0], linear[1])) *
      mirrored;
  const glm::vec3 eye(p.gpu.local_from_relative[3]);  // local
  const float width = p.catcher->published ? 0.0f : outline_width;
  const auto depth_at = [&](const glm::vec3& relative, const glm::vec3& normal) {
    if (p.catcher->published) return p.catcher->halo;  // the texture's own opacity
    if (p.gpu.high.w == 0.0f) return 0.0f;
    // Just over the surface, so that the ray does not end in it.
    const glm::vec3 over = relative + 0.1f * p.gpu.mist.y * normal;
    const glm::vec3 way = glm::mat3(p.gpu.local_from_relative) * glm::normalize(over);
    return layer_depth(scaled, eye, way, glm::length(over) + 12.0f, p.gpu.mist.x, p.gpu.mist.y, steps);
  };
  const auto clear = [&](const glm::vec3& relative, const glm::vec3& normal) {
    const glm::vec3 over = relative + p.gpu.mist.y * normal;
    const glm::vec3 way = glm::mat3(p.gpu.local_from_relative) * glm::normalize(over);
    float lowest = 1.0f;
    for (int i = 1; i <= 9; ++i) {
      const glm::vec3 at = eye + way * (glm::length(over) + seam_m * static_cast<float>(i) / 9.0f);
      const glm::vec3 surface = surface_at(scaled, at.x, at.z);
      if (surface.y > 0.5f) lowest = std::min(lowest, at.y - surface.x);
    }
    return glm::smoothstep(-0.05f, -0.01f, lowest);
  };
  const std::size_t first_fin = fins.size();
  double drawn = 0.0;
  for (const CatcherEdge& e : shape.edges) {
    const glm::vec3 a = p.relative_from_object * glm::vec4(shape.positions[e.a], 1.0f);
    const glm::vec3 b = p.relative_from_object * glm::vec4(shape.positions[e.b], 1.0f);
    const glm::vec3 to_eye = -0.5f * (a + b);
    const float away = glm::length(to_eye);
    if (!(away > 1e-4f)) continue;
    const glm::vec3 face_a = glm::normalize(turn * e.face_a), face_b = glm::normalize(turn * e.face_b);
    float share = outline_share(glm::dot(face_a, to_eye) / away, glm::dot(face_b, to_eye) / away, width);
    if (share < 1e-3f) continue;
    const glm::vec3 normal_a = glm::normalize(turn * shape.normals[e.a]),
                    normal_b = glm::normalize(turn * shape.normals[e.b]);
    if (!p.catcher->published) {
      if (std::max(normal_a.y, normal_b.y) < 0.05f) continue;
      if (p.gpu.high.w != 0.0f) share *= clear(0.5f * (a + b), glm::normalize(normal_a + normal_b));
      if (share < 1e-3f) continue;
    }
    const glm::vec3 along = glm::abs((shape.positions[e.b] - shape.positions[e.a]) * p.scale);
    const int axis = along.x >= along.y && along.x >= along.z ? 0 : along.y >= along.z ? 1 : 2;
    FinGpu fin;
    fin.a_depth = glm::vec4(a, depth_at(a, normal_a));
    fin.b_depth = glm::vec4(b, depth_at(b, normal_b));
    if (fin.a_depth.w + fin.b_depth.w < 1e-6f) continue;
    fin.a_normal = glm::vec4(normal_a, shape.positions[e.a][axis] * p.scale[axis]);
    fin.b_normal = glm::vec4(normal_b, shape.positions[e.b][axis] * p.scale[axis]);
    fin.struck = glm::vec4(face_a.y >= face_b.y ? face_a : face_b, share);
    fins.push_back(fin);
    // A quad's light: its depth over the solid angle that it takes, heights summed in closed form.
    const glm::vec3 up = 0.5f * (normal_a + normal_b);
    drawn += 0.5 * (fin.a_depth.w + fin.b_depth.w) * share * std::abs(glm::dot(glm::cross(b - a, up), to_eye)) *
             p.gpu.mist.y / (away * away * away);
  }
  if (p.catcher->published || !(drawn > 0.0)) return;
  // Fins have no mist within the outline: what stands there is gathered along it, so that the whole is as bright.
  double whole = 0.0;
  const double column = double(p.gpu.mist.x) * p.gpu.mist.y;
  for (const CatcherShape::Patch& patch : shape.upper) {
    const glm::vec3 to_eye = -glm::vec3(p.relative_from_object * glm::vec4(patch.middle, 1.0f));
    const float square = std::max(glm::dot(to_eye, to_eye), 0.25f);
    const float cosine = glm::dot(glm::normalize(turn * patch.normal), to_eye) / std::sqrt(square);
    whole += column * patch.level_m2 * double(p.scale.x * p.scale.z) *
             glm::smoothstep(-outline_width, outline_width, cosine) / square;
  }
  const auto gathered = static_cast<float>(std::min(whole / drawn, double(most_gathered)));
  for (std::size_t i = first_fin; i < fins.size(); ++i) fins[i].a_depth.w *= gathered, fins[i].b_depth.w *= gathered;
}

}  // namespace petrichor
