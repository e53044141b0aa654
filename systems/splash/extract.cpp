#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>

#include "components/water.hpp"
#include "components/weather.hpp"
#include "systems/drip_frame.hpp"
#include "systems/splash/splash.hpp"
#include "systems/splash_frame.hpp"

namespace petrichor {
namespace {

// A patch in its mesh's own space; normal and area in one.
struct LocalGlow {
  glm::vec3 place_m, area_m2, radiance;
};
using MeshGlows = std::vector<std::vector<LocalGlow>>;  // by mesh

glm::vec3 texel_of(const Image& image, glm::vec2 uv) {
  if (image.width <= 0 || image.height <= 0 || image.is_float) return glm::vec3(1.0f);
  uv -= glm::floor(uv);
  const int x = std::min(int(uv.x * float(image.width)), image.width - 1);
  const int y = std::min(int(uv.y * float(image.height)), image.height - 1);
  const std::uint8_t* p = &image.pixels[(std::size_t(y) * image.width + x) * 4];
  const glm::vec3 c = glm::vec3(p[0], p[1], p[2]) / 255.0f;
  return glm::pow(c, glm::vec3(2.2f));
}

// Triangles that shine, gathered by cells of two metres and by the way they face.
MeshGlows glows_of(const Model& model) {
  MeshGlows all(model.meshes.size());
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    using Key = std::tuple<int, int, int, int>;
    std::map<Key, std::tuple<glm::vec3, glm::vec3, glm::vec3, float>> patches;  // place, area, radiance, weight
    for (const Primitive& p : model.meshes[m].primitives) {
      if (p.material == no_index) continue;
      const Material& material = model.materials[std::size_t(p.material)];
      if (std::max({material.emissive.r, material.emissive.g, material.emissive.b}) <= 0.0f) continue;
      const TextureUse& use = material.emissive_texture;
      for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3) {
        const Vertex &a = p.vertices[p.indices[i]], &b = p.vertices[p.indices[i + 1]],
                     &c = p.vertices[p.indices[i + 2]];
        const glm::vec3 area = 0.5f * glm::cross(b.position_m - a.position_m, c.position_m - a.position_m);
        const float size = glm::length(area);
        if (!(size > 1e-8f)) continue;
        glm::vec3 radiance = material.emissive;
        if (use.image != no_index) {
          // At the corners' middles and the centre.
          glm::vec3 mean(0.0f);
          const glm::vec3 at[4] = {{0.34f, 0.33f, 0.33f}, {0.6f, 0.2f, 0.2f}, {0.2f, 0.6f, 0.2f}, {0.2f, 0.2f, 0.6f}};
          for (const glm::vec3& w : at) {
            const glm::vec2 uv =
                use.texcoord == 0 ? w.x * a.uv0 + w.y * b.uv0 + w.z * c.uv0 : w.x * a.uv1 + w.y * b.uv1 + w.z * c.uv1;
            mean += 0.25f * texel_of(model.images[std::size_t(use.image)], uv * use.scale + use.offset);
          }
          radiance *= mean;
        }
        const glm::vec3 centre = (a.position_m + b.position_m + c.position_m) / 3.0f;
        const glm::ivec3 cell(glm::floor(centre / 2.0f));
        const glm::vec3 n = area / size;
        const int way = (n.x > 0.5f    ? 1
                         : n.x < -0.5f ? 2
                                       : 0) +
                        3 * (n.y > 0.5f    ? 1
                             : n.y < -0.5f ? 2
                                           : 0) +
                        9 * (n.z > 0.5f    ? 1
                             : n.z < -0.5f ? 2
                                           : 0);
        auto& [place, sum, light, weight] = patches[Key(cell.x, cell.y, cell.z, way)];
        place += centre * size;
        sum += area;
        light += radiance * size;
        weight += size;
      }
    }
    for (const auto& [key, patch] : patches) {
      const auto& [place, area, light, weight] = patch;
      all[m].push_back({place / weight, area, light / weight});
    }
  }
  return all;
}

const MeshGlows& known_glows(const std::shared_ptr<const Model>& model) {
  static std::map<const Model*, std::pair<std::weak_ptr<const Model>, MeshGlows>> known;
  auto& [owner, glows] = known[model.get()];
  if (owner.lock() != model) {
    owner = model;
    glows = glows_of(*model);
  }
  return glows;
}

}  // namespace

std::vector<SplashGlow> splash_glows(const Frame& frame, const std::vector<std::shared_ptr<const Model>>& models,
                                     float reach_m) {
  std::vector<SplashGlow> glows;
  for (const FrameInstance& instance : frame.instances) {
    if (instance.model >= models.size() || !models[instance.model]) continue;
    const MeshGlows& of_model = known_glows(models[instance.model]);
    if (instance.mesh >= of_model.size()) continue;
    for (const LocalGlow& g : of_model[instance.mesh]) {
      SplashGlow glow;
      glow.place_m = glm::vec3(instance.matrix * glm::vec4(g.place_m, 1.0f));
      if (glm::distance(glow.place_m, glm::vec3(frame.camera.position_m)) > reach_m) continue;
      const glm::vec3 area = glm::mat3(instance.matrix) * g.area_m2;  // rigid
      const float size = glm::length(area), scale = std::max(size, 1e-4f);
      glow.normal = size > 1e-3f ? area / size : glm::vec3(0.0f);
      glow.intensity = g.radiance * scale;
      // The glass of a lamp that is a light already.
      bool lamp = false;
      for (const FrameLight& light : frame.lights)
        lamp = lamp || (light.kind != LIGHT_DIRECTIONAL && light.lights_rain &&
                        glm::distance(light.position_m, glow.place_m) < 0.7f);
      if (!lamp) glows.push_back(glow);
    }
  }
  // The strongest, if there are very many.
  constexpr std::size_t most = 1024;
  if (glows.size() > most) {
    const auto strength = [](const SplashGlow& g) { return g.intensity.r + g.intensity.g + g.intensity.b; };
    std::stable_sort(glows.begin(), glows.end(),
                     [&](const SplashGlow& a, const SplashGlow& b) { return strength(a) > strength(b); });
    glows.resize(most);
  }
  return glows;
}

void extract_splashes(const Registry& registry, Frame& frame, const std::vector<std::shared_ptr<const Model>>& models) {
  frame.splashes.reset();
  const bool rains = frame.rain && frame.rain->rain_mm_per_hour > 0.0f;
  const bool drips = frame.drips && !frame.drips->landings.empty();
  if ((!rains && !drips) || frame.techniques.share(Effect::splashes, SplashRung::none) >= 1.0f) return;
  auto splashes = std::make_shared<FrameSplashes>();
  Entity entity{};
  bool any = false;
  registry.view<const Splashes>().each([&](Entity e, const Splashes&) {
    if (!any || entity_index(e) < entity_index(entity)) entity = e, any = true;
  });
  if (any) {
    const Splashes& set = *registry.find<Splashes>(entity);
    splashes->reach_m = set.reach_m;
    splashes->secondary_reach_m = set.secondary_reach_m;
    splashes->most_splashes = set.most_splashes;
    splashes->published = set.published;
    splashes->size = set.size;
    splashes->size_variation = set.size_variation;
    splashes->opacity = set.opacity;
    splashes->opacity_variation = set.opacity_variation;
    splashes->edge_strength = set.edge_strength;
    splashes->edge_bias = set.edge_bias;
    splashes->backlight = set.backlight;
  }
  splashes->glows = splash_glows(frame, models, splashes->reach_m + 32.0f);
  frame.splashes = std::move(splashes);
}

}  // namespace petrichor
