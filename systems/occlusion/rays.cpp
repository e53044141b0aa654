#include "systems/occlusion/rays.hpp"

#include <embree3/rtcore.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace petrichor {

struct ShelterRays::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

ShelterRays::ShelterRays(std::span<const Model* const> models, std::span<const FrameInstance> instances)
    : impl_(std::make_unique<Impl>()) {
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> indices;
  for (const FrameInstance& instance : instances) {
    for (const Primitive& primitive : models[instance.model]->meshes[instance.mesh].primitives) {
      const auto base = static_cast<std::uint32_t>(vertices.size());
      for (const Vertex& v : primitive.vertices) vertices.push_back(instance.matrix * glm::vec4(v.position_m, 1.0f));
      for (const std::uint32_t index : primitive.indices) indices.push_back(base + index);
    }
  }
  impl_->device = rtcNewDevice("threads=2");
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);  // rays along shared edges must not slip through
  if (!indices.empty()) {
    RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* to = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertices.size());
    std::memcpy(to, vertices.data(), vertices.size() * 12);
    to = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, indices.size() / 3);
    std::memcpy(to, indices.data(), indices.size() * 4);
    rtcCommitGeometry(g);
    rtcAttachGeometry(impl_->scene, g);
    rtcReleaseGeometry(g);
  }
  rtcCommitScene(impl_->scene);
}

ShelterRays::~ShelterRays() {
  rtcReleaseScene(impl_->scene);
  rtcReleaseDevice(impl_->device);
}

float ShelterRays::distance_m(const glm::vec3& from, const glm::vec3& way) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray{};
  ray.ray.org_x = from.x, ray.ray.org_y = from.y, ray.ray.org_z = from.z;
  ray.ray.dir_x = way.x, ray.ray.dir_y = way.y, ray.ray.dir_z = way.z;
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context, &ray);
  return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : ray.ray.tfar;
}

bool ShelterRays::sheltered(const glm::vec3& place, const glm::vec3& velocity) const {
  const glm::vec3 way = -glm::normalize(velocity);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  ray.org_x = place.x, ray.org_y = place.y, ray.org_z = place.z;
  ray.dir_x = way.x, ray.dir_y = way.y, ray.dir_z = way.z;
  ray.tnear = 1e-3f;
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = ~0u;
  rtcOccluded1(impl_->scene, &context, &ray);
  return ray.tfar < 0.0f;
}

}  // namespace petrichor
