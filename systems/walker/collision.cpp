#include "systems/walker/collision.hpp"

#include <embree3/rtcore.h>

#include <cstring>

#include "components/transform.hpp"
#include "components/view.hpp"

namespace petrichor {

struct CollisionScene::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

CollisionScene::CollisionScene(Registry& registry, const std::vector<std::shared_ptr<const Model>>& models)
    : impl_(std::make_unique<Impl>()) {
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> indices;
  registry.view<const MeshInstance, const WorldTransform>().each(
      [&](Entity, const MeshInstance& instance, const WorldTransform& placed) {
        if (instance.model >= models.size() || instance.mesh >= models[instance.model]->meshes.size()) return;
        for (const Primitive& primitive : models[instance.model]->meshes[instance.mesh].primitives) {
          const auto base = static_cast<std::uint32_t>(vertices.size());
          for (const Vertex& vertex : primitive.vertices)
            vertices.push_back(placed.matrix * glm::vec4(vertex.position_m, 1.0f));
          for (const std::uint32_t index : primitive.indices) indices.push_back(base + index);
        }
      });
  impl_->device = rtcNewDevice("threads=2");
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);  // rays along shared edges must not slip through
  if (!indices.empty()) {
    RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* to = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                       vertices.size());
    std::memcpy(to, vertices.data(), vertices.size() * sizeof(glm::vec3));
    to = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t),
                                 indices.size() / 3);
    std::memcpy(to, indices.data(), indices.size() * sizeof(std::uint32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(impl_->scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(impl_->scene);
}

CollisionScene::~CollisionScene() {
  rtcReleaseScene(impl_->scene);
  rtcReleaseDevice(impl_->device);
}

std::optional<RayHit> CollisionScene::cast(const glm::vec3& origin_m, const glm::vec3& direction, float reach_m) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray{};
  ray.ray.org_x = origin_m.x, ray.ray.org_y = origin_m.y, ray.ray.org_z = origin_m.z;
  ray.ray.dir_x = direction.x, ray.ray.dir_y = direction.y, ray.ray.dir_z = direction.z;
  ray.ray.tfar = reach_m;
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  glm::vec3 normal = glm::normalize(glm::vec3(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z));
  if (glm::dot(normal, direction) > 0.0f) normal = -normal;
  return RayHit{ray.ray.tfar, normal};
}

}  // namespace petrichor
