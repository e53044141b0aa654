#include "systems/reflection/choose.hpp"

#include <algorithm>
#include <cmath>

namespace petrichor {
namespace {

constexpr float pi = 3.14159265f;
constexpr float farthest_m = 150.0f;
constexpr std::size_t most_posts = MAXIMUM_REFLECTORS / 4;

float strongest(const glm::vec3& v) {
  return std::max({v.x, v.y, v.z});
}

struct Candidate {
  Reflector reflector;
  float importance = 0.0f;
  float distance_m = 0.0f;
  float share = 1.0f;
  int kind = REFLECTOR_PANEL;
};

// The light that punctual lights at its place send out already: their candela over its area.
glm::vec3 less_its_lights(const Reflector& r, const Frame& frame) {
  const float across = glm::length(r.half_across), up = glm::length(r.half_up);
  const float near = std::hypot(across, up) + 0.5f, area = 4.0f * across * up;
  glm::vec3 left = r.radiance;
  for (const FrameLight& light : frame.lights) {
    if (light.kind == LIGHT_DIRECTIONAL) continue;
    const glm::vec3 away = light.position_m - r.centre_m;
    if (glm::dot(away, away) < near * near) left -= light.intensity / area;
  }
  return glm::max(left, glm::vec3(0.0f));
}

// Lambert, from all lamps: "we render the impostors lit with the scene illumination" (section 6.3). An upright post
// shows the eye about half of what arrives from the side.
glm::vec3 lit_post(const Reflector& post, const Frame& frame) {
  glm::vec3 arrives = glm::vec3(frame.sky.horizon_cd_m2) * pi;
  for (const FrameLight& light : frame.lights) {
    if (light.kind == LIGHT_DIRECTIONAL) continue;
    const glm::vec3 away = post.centre_m - light.position_m;
    const float d2 = std::max(glm::dot(away, away), 1.0f);
    if (light.kind == LIGHT_SPOT && glm::dot(away, light.direction) < std::sqrt(d2) * std::cos(light.outer_cone_rad))
      continue;
    arrives += light.intensity * (0.5f * std::hypot(away.x, away.z) / (d2 * std::sqrt(d2)));
  }
  return post.radiance * arrives / pi;
}

// Keeps the `most` most important; those near the last fade.
void keep(std::vector<Candidate>& all, std::size_t most) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.importance > b.importance; });
  if (all.size() <= most) return;
  const float last = all[most].importance;
  all.resize(most);
  for (Candidate& c : all) c.share = std::clamp(c.importance / std::max(last, 1e-12f) - 1.0f, 0.0f, 1.0f);
}

}  // namespace

ReflectorsGpu choose_reflectors(const Frame& frame, const std::vector<Reflector>& all, bool with_lamps) {
  const glm::vec3 eye(frame.camera.position_m), forward = frame.camera.orientation * glm::vec3(0, 0, -1);
  std::vector<Candidate> shining, posts;
  const auto offer = [&](const Reflector& r, int kind, std::vector<Candidate>& list) {
    const glm::vec3 to = r.centre_m - eye;
    const float distance = glm::length(to), reach = std::hypot(glm::length(r.half_across), glm::length(r.half_up));
    if (distance > farthest_m) return;
    Candidate c{r, 0.0f, distance, 1.0f, kind};
    // Behind the eye only rough ground could mirror it; it fades there.
    const float ahead = glm::dot(to, forward) + reach;
    const float fade = std::clamp(ahead / (0.3f * distance + 0.5f) + 1.0f, 0.0f, 1.0f);
    const float area = 4.0f * glm::length(r.half_across) * glm::length(r.half_up);
    const float bright = kind == REFLECTOR_POST ? 0.3f : strongest(r.radiance);
    c.importance = bright * area * fade / (distance * distance + reach * reach);
    c.reflector.radiance *= fade;
    if (c.importance > 0.0f) list.push_back(c);
  };
  for (const Reflector& r : all)
    r.kind == ReflectorKind::post
        ? offer(r, REFLECTOR_POST, posts)
        : offer(r, r.kind == ReflectorKind::lantern ? REFLECTOR_LANTERN : REFLECTOR_PANEL, shining);
  const std::size_t most = MAXIMUM_REFLECTORS - most_posts;
  if (shining.size() > 2 * most) {  // what is taken off by lights costs too much to ask for all
    keep(shining, 2 * most);
  }
  for (Candidate& c : shining) {
    const float before = strongest(c.reflector.radiance);
    c.reflector.radiance = less_its_lights(c.reflector, frame);
    c.importance *= strongest(c.reflector.radiance) / std::max(before, 1e-6f);
  }
  if (with_lamps)
    for (const FrameLight& light : frame.lights) {
      if (light.kind == LIGHT_DIRECTIONAL || strongest(light.intensity) <= 0.0f) continue;
      const float radius = std::max(light.source_radius_m, 0.03f);
      glm::vec3 intensity = light.intensity;
      if (light.kind == LIGHT_SPOT) {  // as seen from the ground before the eye
        const glm::vec3 way = glm::normalize(glm::vec3(eye.x, 0.0f, eye.z) - light.position_m);
        const float inner = std::cos(light.inner_cone_rad), outer = std::cos(light.outer_cone_rad);
        const float x =
            std::clamp((glm::dot(way, light.direction) - outer) / std::max(inner - outer, 1e-3f), 0.0f, 1.0f);
        intensity *= x * x;
      }
      Reflector r{ReflectorKind::lantern,
                  light.position_m,
                  {radius, 0, 0},
                  {0, radius, 0},
                  intensity / (4.0f * radius * radius)};
      offer(r, REFLECTOR_LAMP, shining);
    }
  std::erase_if(shining, [](const Candidate& c) { return !(c.importance > 0.0f); });
  keep(shining, most);
  keep(posts, most_posts);  // before they are lit, by all lamps: the town has many
  for (Candidate& c : posts) c.reflector.radiance = lit_post(c.reflector, frame);

  shining.insert(shining.end(), posts.begin(), posts.end());
  std::stable_sort(shining.begin(), shining.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance_m < b.distance_m; });
  ReflectorsGpu out{};
  for (const Candidate& c : shining) {
    const Reflector& r = c.reflector;
    const glm::vec3 centre(glm::dvec3(r.centre_m) - frame.camera.position_m);
    out.all[out.counts.x++] = {glm::vec4(centre, static_cast<float>(c.kind)), glm::vec4(r.half_across, c.share),
                               glm::vec4(r.half_up, glm::length(r.half_across + r.half_up)),
                               glm::vec4(r.radiance, c.distance_m)};
  }
  return out;
}

}  // namespace petrichor
