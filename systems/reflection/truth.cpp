#include "systems/reflection/truth.hpp"

#include <embree3/rtcore.h>

#include <cmath>
#include <limits>
#include <random>

#include "systems/reflection/streak.h"

namespace petrichor {
namespace {

constexpr float farthest_m = 1e4f;

struct Surface {
  glm::vec3 place{0.0f}, normal{0.0f};
  const Material* material = nullptr;
};

class Rays {
 public:
  explicit Rays(const StageScene& scene) : scene_(scene), device_(rtcNewDevice("threads=1")) {
    rays_ = rtcNewScene(device_);
    for (const Mesh& mesh : scene.model.meshes)
      for (const Primitive& p : mesh.primitives) {
        RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* v = static_cast<float*>(
            rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, p.vertices.size()));
        for (const Vertex& vertex : p.vertices)
          for (int k = 0; k < 3; ++k) *v++ = vertex.position_m[k];
        auto* index = static_cast<unsigned*>(
            rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, p.indices.size() / 3));
        std::copy(p.indices.begin(), p.indices.end(), index);
        rtcCommitGeometry(g);
        rtcAttachGeometry(rays_, g);
        rtcReleaseGeometry(g);
        materials_.push_back(&scene.model.materials[static_cast<std::size_t>(p.material)]);
      }
    rtcCommitScene(rays_);
  }
  ~Rays() {
    rtcReleaseScene(rays_);
    rtcReleaseDevice(device_);
  }
  Rays(const Rays&) = delete;
  Rays& operator=(const Rays&) = delete;

  bool meet(glm::vec3 from, glm::vec3 way, Surface& found) const {
    RTCRayHit r{};
    set(r.ray, from, way, farthest_m);
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(rays_, &context, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    found.place = from + way * r.ray.tfar;
    found.normal = glm::normalize(glm::vec3(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z));
    if (glm::dot(found.normal, way) > 0.0f) found.normal = -found.normal;
    found.material = materials_[r.hit.geomID];
    return true;
  }
  bool blocked(glm::vec3 from, glm::vec3 to) const {
    RTCRay r{};
    const glm::vec3 way = to - from;
    set(r, from, way, 0.999f);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(rays_, &context, &r);
    return r.tfar < 0.0f;
  }
  // What a matt surface sends out.
  glm::vec3 matt(const Surface& s) const {
    glm::vec3 arrives(0.0f);
    for (const FrameLight& light : scene_.lights) {
      const glm::vec3 to = light.position_m - s.place;
      const float d2 = glm::dot(to, to), cosine = glm::dot(to, s.normal) / std::sqrt(d2);
      if (cosine > 0.0f && !blocked(s.place + s.normal * 1e-3f, light.position_m))
        arrives += light.intensity * (cosine / d2);
    }
    return s.material->emissive + glm::vec3(s.material->base_colour) * arrives / shading::PI;
  }

 private:
  static void set(RTCRay& r, glm::vec3 from, glm::vec3 way, float far) {
    r.org_x = from.x, r.org_y = from.y, r.org_z = from.z;
    r.dir_x = way.x, r.dir_y = way.y, r.dir_z = way.z;
    r.tnear = 0.0f, r.tfar = far, r.mask = ~0u;
  }
  const StageScene& scene_;
  RTCDevice device_;
  RTCScene rays_;
  std::vector<const Material*> materials_;
};

glm::vec3 sky_of(const FrameSky& sky, glm::vec3 way) {  // systems/sky.glsl
  const float glow = std::exp(-std::max(way.y, 0.0f) / std::max(sky.glow_height, 1e-3f));
  return glm::mix(sky.zenith_cd_m2, sky.horizon_cd_m2, glow);
}

struct Facing {
  glm::vec3 v, n, t, b;
  float alpha, n_dot_v;
};

// The lamps: spheres, each as points over its disc.
glm::vec3 lamps(const Rays& rays, const StageScene& scene, const Surface& at, const Facing& f, std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  glm::vec3 sum(0.0f);
  constexpr int points = 4;  // a pixel has sixteen of these
  for (const FrameLight& light : scene.lights) {
    const glm::vec3 to = light.position_m - at.place;
    const glm::vec3 aside = glm::normalize(glm::cross(to, glm::vec3(0, 1, 0.01f))),
                    up = glm::normalize(glm::cross(aside, to));
    for (int i = 0; i < points; ++i) {
      const float r = light.source_radius_m * std::sqrt((static_cast<float>(i) + unit(random)) / points);
      const float turn = 2.399963f * static_cast<float>(i) + 0.5f * unit(random);
      const glm::vec3 place = light.position_m + (aside * std::cos(turn) + up * std::sin(turn)) * r,
                      way = place - at.place;
      const float d2 = glm::dot(way, way);
      const glm::vec3 l = way / std::sqrt(d2), h = glm::normalize(l + f.v);
      const float n_dot_l = glm::dot(f.n, l);
      if (n_dot_l <= 0.0f || rays.blocked(at.place + f.n * 1e-3f, place)) continue;
      const float a2 = f.alpha * f.alpha;
      const float d = shading::ggx_distribution(glm::dot(f.n, h), a2);
      const float fresnel = shading::fresnel(glm::vec3(shading::DIELECTRIC_F0), glm::dot(f.v, h), 1.0f).x;
      sum +=
          light.intensity * (d * shading::smith_visibility(n_dot_l, f.n_dot_v, a2) * fresnel * n_dot_l / d2 / points);
    }
  }
  return sum;
}

// What one point mirrors to the eye, that looks along `way`.
glm::vec3 mirrored(const Rays& rays, const StageScene& scene, const Frame& frame, const Surface& at, glm::vec3 way,
                   int strata, std::mt19937& random) {
  Facing f;
  f.v = -way;
  f.n = at.normal;
  f.n_dot_v = glm::clamp(glm::dot(f.n, f.v), 0.02f, 1.0f);
  f.alpha = std::max(at.material->roughness * at.material->roughness, 2e-3f);
  f.b = glm::normalize(glm::cross(f.n, f.v));
  f.t = glm::cross(f.b, f.n);
  const glm::vec3 v_local(glm::dot(f.v, f.t), 0.0f, f.n_dot_v);
  glm::vec3 round(0.0f);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int i = 0; i < strata; ++i)
    for (int j = 0; j < strata; ++j) {
      // GGX's slopes: P(m < r) = r^2 / (a^2 + r^2).
      const float u = (static_cast<float>(i) + unit(random)) / static_cast<float>(strata);
      const float turn = 6.2831853f * (static_cast<float>(j) + unit(random)) / static_cast<float>(strata);
      const float r = f.alpha * std::sqrt(u / std::max(1.0f - u, 1e-6f));
      const glm::vec2 slope(r * std::cos(turn), r * std::sin(turn));
      const glm::vec2 weight = shading::facet_weight(slope, v_local, f.alpha * f.alpha);
      const glm::vec3 h = glm::normalize(f.n + f.t * slope.x + f.b * slope.y), l = glm::reflect(way, h);
      if (glm::dot(l, f.n) <= 0.0f || weight.x <= 0.0f) continue;
      const float fresnel = shading::fresnel(glm::vec3(shading::DIELECTRIC_F0), weight.y, 1.0f).x;
      Surface met;
      const bool hit = rays.meet(at.place + f.n * 1e-3f, l, met);
      round += (hit ? rays.matt(met) : sky_of(frame.sky, l)) * (weight.x * fresnel);
    }
  return lamps(rays, scene, at, f, random) + round / static_cast<float>(strata * strata);
}

}  // namespace

std::vector<glm::vec4> reflection_truth(const StageScene& scene, const Frame& frame, int samples, std::uint32_t seed) {
  const Rays rays(scene);
  constexpr int parts = 4;  // of a pixel's side
  const int strata = std::max(static_cast<int>(std::sqrt(static_cast<double>(samples) / (parts * parts)) + 0.5), 1);
  std::vector<glm::vec4> picture(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  const float tall = std::tan(0.5f * frame.camera.vertical_fov_rad);
  const float wide = tall * static_cast<float>(frame.width) / static_cast<float>(frame.height);
  const glm::vec3 eye(frame.camera.position_m);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      std::mt19937 random(seed * 7919u + static_cast<unsigned>(y * frame.width + x));
      std::uniform_real_distribution<float> unit(0.0f, 1.0f);
      const auto meet = [&](float u, float v, glm::vec3& way, Surface& at) {
        way = glm::normalize(
            frame.camera.orientation *
            glm::vec3((2.0f * (static_cast<float>(x) + u) / static_cast<float>(frame.width) - 1.0f) * wide,
                      (2.0f * (static_cast<float>(y) + v) / static_cast<float>(frame.height) - 1.0f) * tall, -1.0f));
        return rays.meet(eye, way, at) && shading::mirror_share(at.material->roughness) > 0.0f;
      };
      glm::vec3 way;
      Surface at;
      if (!meet(0.5f, 0.5f, way, at)) continue;
      glm::vec3 pixel(0.0f);
      float met_ground = 0.0f;
      for (int part = 0; part < parts * parts; ++part) {
        if (!meet((static_cast<float>(part % parts) + unit(random)) / parts,
                  (static_cast<float>(part / parts) + unit(random)) / parts, way, at))
          continue;
        pixel += mirrored(rays, scene, frame, at, way, strata, random);
        met_ground += 1.0f;
      }
      if (met_ground > 0.0f)
        picture[static_cast<std::size_t>(y * frame.width + x)] = glm::vec4(pixel / met_ground, 1.0f);
    }
  return picture;
}

}  // namespace petrichor
