#include "systems/drip/surfaces.hpp"

#include <embree3/rtcore.h>

#include <cmath>
#include <limits>

#include "systems/drip/motion.hpp"
#include "systems/drip/physics.hpp"
#include "systems/drops/drop_physics.hpp"

namespace petrichor {

constexpr double cell = 0.5;  // m/s

struct DripSurfaces::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  // Along a stretch of the way; infinity where nothing is hit within it.
  double hit(const glm::dvec3& from, const glm::dvec3& to, double skip_m) const {
    const double length = glm::length(to - from);
    const glm::dvec3 way = (to - from) / length;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(from.x), ray.ray.org_y = static_cast<float>(from.y);
    ray.ray.org_z = static_cast<float>(from.z);
    ray.ray.dir_x = static_cast<float>(way.x), ray.ray.dir_y = static_cast<float>(way.y);
    ray.ray.dir_z = static_cast<float>(way.z);
    ray.ray.tnear = static_cast<float>(skip_m);
    ray.ray.tfar = static_cast<float>(length);
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &ray);
    return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<double>::infinity()
                                                     : static_cast<double>(ray.ray.tfar);
  }
};

DripSurfaces::DripSurfaces(std::span<const DripObstacle> obstacles) : impl_(std::make_unique<Impl>()) {
  std::size_t vertices = 0, indices = 0;
  for (const DripObstacle& o : obstacles)
    for (const Primitive& p : o.mesh->primitives) vertices += p.vertices.size(), indices += p.indices.size();
  impl_->device = rtcNewDevice("threads=2");
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);         // drops along shared edges must not slip through
  rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_LOW);  // few rays: building it is what costs
  if (indices > 0) {
    RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* at = static_cast<glm::vec3*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), vertices));
    auto* index = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, indices / 3));
    std::uint32_t base = 0;
    for (const DripObstacle& o : obstacles)
      for (const Primitive& p : o.mesh->primitives) {
        for (const Vertex& v : p.vertices) *at++ = glm::vec3(o.matrix * glm::vec4(v.position_m, 1.0f));
        for (const std::uint32_t i : p.indices) *index++ = base + i;
        base += static_cast<std::uint32_t>(p.vertices.size());
      }
    rtcCommitGeometry(g);
    rtcAttachGeometry(impl_->scene, g);
    rtcReleaseGeometry(g);
  }
  rtcCommitScene(impl_->scene);
}

DripSurfaces::~DripSurfaces() {
  rtcReleaseScene(impl_->scene);
  rtcReleaseDevice(impl_->device);
}

const std::vector<float>& DripSurfaces::falls(const DripSourceMotion& s, const DripPose& pose,
                                              const glm::dvec3& wind_mps) {
  constexpr double own_edge_m = 0.05;
  const glm::ivec3 at = cell_of(s, wind_mps);
  const int cx = at.x, cz = at.z;
  const Key key{s.life, s.edge, pose.number, cx, cz};
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  const glm::dvec3 wind(cell * cx, 0.0, cell * cz);
  const double terminal = terminal_speed_mps(diameter_mm_of(s.drop_m3));
  std::vector<float> falls(static_cast<std::size_t>(s.sites), static_cast<float>(longest_fall_m));
  // In wind the way bends: straight pieces of it.
  static constexpr double bent[] = {0.5, 1.5, 3.0, 6.0, 12.0, 24.0, longest_fall_m}, straight[] = {longest_fall_m};
  const std::span<const double> depths = cx == 0 && cz == 0 ? std::span<const double>(straight) : bent;
  for (int i = 0; i < s.sites; ++i) {
    const glm::dvec3 lip(pose.matrix * glm::vec4(static_cast<float>(drip_site(s, i).along_m), 0.0f, 0.0f, 1.0f));
    glm::dvec3 from = lip;
    for (const double depth : depths) {
      const DripFall fall = fall_after(terminal, time_to_fall_s(terminal, depth), glm::length(wind));
      const glm::dvec3 to = lip + wind * fall.drift_s - glm::dvec3(0.0, depth, 0.0);
      // The lip itself is no obstacle.
      const double hit = impl_->hit(from, to, from == lip ? own_edge_m : 0.0);
      if (hit < std::numeric_limits<double>::infinity()) {
        falls[static_cast<std::size_t>(i)] =
            static_cast<float>(lip.y - from.y + hit * (from.y - to.y) / glm::length(to - from));
        break;
      }
      from = to;
    }
  }
  return known_.emplace(key, std::move(falls)).first->second;
}

glm::ivec3 DripSurfaces::cell_of(const DripSourceMotion& s, const glm::dvec3& wind_mps) {
  return {static_cast<int>(std::lround(wind_mps.x * s.set.wind / cell)), 0,
          static_cast<int>(std::lround(wind_mps.z * s.set.wind / cell))};
}

void DripSurfaces::forget() {
  if (known_.size() > 1024) known_.clear();
}

}  // namespace petrichor
