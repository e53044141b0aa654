#include "systems/mirror/extract.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "components/reflection.hpp"
#include "components/transform.hpp"
#include "components/view.hpp"
#include "components/water.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/frustum.hpp"
#include "systems/mirror/camera.hpp"
#include "systems/mirror/mirror.hpp"
#include "systems/puddle_frame.hpp"

namespace petrichor {
namespace {

constexpr float probe_reach_m = 60.0f;  // objects farther away mirror what all share
constexpr float least_share = 0.002f;   // of the picture: a pane or a puddle that is smaller is not worth a mirror
constexpr float street_half_m = 40.0f;  // of wet ground without puddles
constexpr float same_level_m = 0.12f;   // puddles whose levels differ by about so much are mirrored as one plane
constexpr float other_level_m = 0.5f;

float smooth(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

struct MirrorView {
  glm::dvec3 eye_m;
  glm::mat4 clip;
  Frustum frustum;
};

MirrorView view_of(const Frame& frame) {
  const FrameCamera& c = frame.camera;
  const float aspect = static_cast<float>(std::max(frame.width, 1)) / static_cast<float>(std::max(frame.height, 1));
  MirrorView view{c.position_m, view_projection_of(c.orientation, c.vertical_fov_rad, aspect, c.near_m), {}};
  view.frustum = frustum_of(view.clip);
  return view;
}

void widen(FrameMirrors::Plane& plane, const OnScreen& seen) {
  plane.low = plane.coverage > 0.0f ? glm::min(plane.low, seen.low) : seen.low;
  plane.high = plane.coverage > 0.0f ? glm::max(plane.high, seen.high) : seen.high;
  plane.coverage += seen.share;
}

std::optional<FrameMirrors::Plane> finished(FrameMirrors::Plane plane, float rival) {
  if (plane.coverage < least_share) return std::nullopt;
  plane.share = dominance(plane.coverage, rival);
  // Through the plane the image turns round: it fades where the eye comes near.
  plane.share *= smooth(0.02f, 0.08f, plane.eye_m);
  plane.coverage = std::min(plane.coverage, 1.0f);
  if (plane.share <= 0.0f) return std::nullopt;
  return plane;
}

}  // namespace

float dominance(float first, float second) {
  return second > 0.0f ? std::clamp((first / second - 1.0f) / 0.25f, 0.0f, 1.0f) : 1.0f;
}

std::optional<FrameMirrors::Plane> water_plane(const Frame& frame) {
  if (!frame.puddles || frame.puddles->puddles.empty()) return std::nullopt;
  const MirrorView view = view_of(frame);
  struct Seen {
    double level_m;
    OnScreen on;
  };
  std::vector<Seen> all;
  const auto look = [&](const FramePuddles::Puddle& p, bool filled) {
    const glm::dvec3 origin(glm::vec3(p.world_from_puddle[3]));
    const double level = origin.y - static_cast<double>(p.depth_m - (filled ? p.level_m : p.depth_m));
    if (level > view.eye_m.y) return;  // seen from under the water
    glm::vec3 corners[4];
    for (int i = 0; i < 4; ++i) {
      const float x = (i == 1 || i == 2 ? 1.0f : -1.0f) * p.half_size_m.x,
                  z = (i >= 2 ? 1.0f : -1.0f) * p.half_size_m.y;
      corners[i] = glm::vec3(glm::dvec3(glm::vec3(p.world_from_puddle * glm::vec4(x, 0, z, 1))) - view.eye_m);
      corners[i].y = static_cast<float>(level - view.eye_m.y);
    }
    const OnScreen on = on_screen(view.clip, corners);
    if (on.share > 0.0f) all.push_back({level, on});
  };
  for (const FramePuddles::Puddle& p : frame.puddles->puddles)
    if (p.level_m > 0.0005f) look(p, true);
  if (all.empty()) {
    // No water stands in view, but in the rain the street is wet: its height is that of the hollows nearest to the eye.
    if (!frame.rain || frame.rain->rain_mm_per_hour <= 0.0f) return std::nullopt;
    double sum = 0.0, weights = 0.0;
    for (const FramePuddles::Puddle& p : frame.puddles->puddles) {
      const glm::dvec3 away = glm::dvec3(glm::vec3(p.world_from_puddle[3])) - view.eye_m;
      const double weight = 1.0 / std::pow(1.0 + glm::dot(away, away), 2.0);
      sum += weight * (view.eye_m.y + away.y);
      weights += weight;
    }
    FramePuddles::Puddle street;
    street.world_from_puddle[3] = glm::vec4(static_cast<float>(view.eye_m.x), static_cast<float>(sum / weights),
                                            static_cast<float>(view.eye_m.z), 1);
    street.half_size_m = glm::vec2(street_half_m);
    look(street, false);
    if (all.empty()) return std::nullopt;
  }
  // The level about which most of the picture's water lies, and a mean over what is near it, so that the plane moves
  // smoothly as puddles come into view.
  const auto near = [](double difference) { return std::exp(-0.5 * std::pow(difference / double(same_level_m), 2.0)); };
  double best = 0.0, level = 0.0;
  for (const Seen& s : all) {
    double score = 0.0;
    for (const Seen& t : all) score += static_cast<double>(t.on.share) * near(t.level_m - s.level_m);
    if (score > best) best = score, level = s.level_m;
  }
  double sum = 0.0, weights = 0.0;
  float rival = 0.0f;
  FrameMirrors::Plane plane;
  for (const Seen& s : all) {
    const double weight = static_cast<double>(s.on.share) * near(s.level_m - level);
    sum += weight * s.level_m;
    weights += weight;
    if (std::abs(s.level_m - level) < double(other_level_m)) {
      widen(plane, s.on);
    } else {
      rival += s.on.share;
    }
  }
  plane.eye_m = static_cast<float>(view.eye_m.y - sum / weights);
  plane.tolerance_m = same_level_m;
  return finished(plane, rival);
}

std::optional<FrameMirrors::Plane> pane_plane(const Frame& frame, std::span<const MirrorPane> panes) {
  const MirrorView view = view_of(frame);
  std::vector<FrameMirrors::Plane> planes;
  for (const MirrorPane& pane : panes) {
    const glm::vec3 centre(glm::dvec3(glm::vec3(pane.world[3])) - view.eye_m);
    const glm::vec3 across = glm::vec3(pane.world[0]) * (0.5f * pane.size_m.x);
    const glm::vec3 up = glm::vec3(pane.world[1]) * (0.5f * pane.size_m.y);
    const float radius = glm::length(across) + glm::length(up);
    if (!(radius > 0.0f) || !sphere_touches(view.frustum, centre, radius)) continue;
    glm::vec3 normal = glm::cross(across, up);
    if (!(glm::length(normal) > 0.0f)) continue;
    normal = glm::normalize(normal);
    float eye = -glm::dot(normal, centre);
    if (eye < 0.0f) normal = -normal, eye = -eye;
    const glm::vec3 corners[4] = {centre - across - up, centre + across - up, centre + across + up,
                                  centre - across + up};
    const OnScreen on = on_screen(view.clip, corners);
    if (on.share <= 0.0f) continue;
    // Panes of one front are one mirror.
    auto same = std::find_if(planes.begin(), planes.end(), [&](const FrameMirrors::Plane& p) {
      return glm::dot(p.normal, normal) > 0.9998f && std::abs(p.eye_m - eye) < 0.03f;
    });
    if (same == planes.end()) {
      planes.push_back({normal, eye});
      planes.back().tolerance_m = 0.08f;
      same = planes.end() - 1;
    }
    widen(*same, on);
  }
  if (planes.empty()) return std::nullopt;
  std::stable_sort(planes.begin(), planes.end(), [](const auto& a, const auto& b) { return a.coverage > b.coverage; });
  return finished(planes[0], planes.size() > 1 ? planes[1].coverage : 0.0f);
}

std::vector<FrameMirrors::Probe> nearest_probes(const Frame& frame, std::vector<FrameMirrors::Probe> all) {
  const MirrorView view = view_of(frame);
  const auto distance = [&](const FrameMirrors::Probe& p) {
    return static_cast<float>(glm::length(p.place_m - view.eye_m));
  };
  std::erase_if(all, [&](const auto& p) { return !(distance(p) < probe_reach_m) || !(p.radius_m > 0.0f); });
  std::stable_sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  // One that is about to give its place to another is hardly seen any more.
  const float next = all.size() > PROBES ? distance(all[PROBES]) : INFINITY;
  if (all.size() > PROBES) all.resize(PROBES);
  const float f = 1.0f / std::tan(0.5f * frame.camera.vertical_fov_rad);
  const float aspect = static_cast<float>(std::max(frame.width, 1)) / static_cast<float>(std::max(frame.height, 1));
  for (FrameMirrors::Probe& p : all) {
    const float d = distance(p);
    p.share = (std::isinf(next) ? 1.0f : std::clamp((next - d) / (0.15f * next), 0.0f, 1.0f)) *
              (1.0f - smooth(0.75f * probe_reach_m, probe_reach_m, d));
    const bool in_view = sphere_touches(view.frustum, glm::vec3(p.place_m - view.eye_m), p.radius_m);
    const float tangent = p.radius_m / std::max(d, p.radius_m) * f;
    p.coverage = in_view && p.share > 0.0f ? std::min(0.785398f * tangent * tangent / aspect, 1.0f) : 0.0f;
  }
  return all;
}

void extract_mirrors(const Registry& registry, Frame& frame) {
  auto mirrors = std::make_shared<FrameMirrors>();
  mirrors->water = water_plane(frame);
  std::vector<MirrorPane> panes;
  registry.view<GlassPane, WorldTransform>().each([&](const GlassPane& pane, const WorldTransform& world) {
    panes.push_back({world.matrix, pane.size_m});
  });
  mirrors->pane = pane_plane(frame, panes);

  std::vector<FrameMirrors::Probe> probes;
  registry.view<ReflectionProbe, WorldTransform>().each(
      [&](Entity entity, const ReflectionProbe& probe, const WorldTransform& world) {
        FrameMirrors::Probe p;
        p.place_m = glm::dvec3(glm::vec3(world.matrix * glm::vec4(probe.centre_m, 1.0f)));
        p.radius_m = probe.radius_m;
        p.entity = entity_index(entity);
        probes.push_back(p);
      });
  if (!probes.empty()) {
    mirrors->probes = nearest_probes(frame, std::move(probes));
    registry.view<MeshInstance>().each([&](Entity entity, const MeshInstance&) {
      Entity above = entity;
      for (int depth = 0; depth < 64; ++depth) {  // of the tree
        for (FrameMirrors::Probe& p : mirrors->probes)
          if (entity_index(above) == p.entity) p.own.push_back(entity_index(entity));
        const Parent* parent = registry.find<Parent>(above);
        if (!parent || !registry.alive(parent->entity)) break;
        above = parent->entity;
      }
    });
    for (FrameMirrors::Probe& p : mirrors->probes) std::sort(p.own.begin(), p.own.end());
  }
  frame.mirrors.reset();
  if (mirrors->water || mirrors->pane || !mirrors->probes.empty()) frame.mirrors = std::move(mirrors);
}

}  // namespace petrichor
