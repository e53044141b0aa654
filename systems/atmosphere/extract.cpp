#include "systems/atmosphere/extract.hpp"

#include "components/weather.hpp"

namespace petrichor {
namespace {

// Of several, the one that was made first wins, so that the answer does not depend on storage order.
template <class T, class Fn>
void first_of(const Registry& registry, Fn&& fn) {
  Entity chosen = null_entity;
  const T* component = nullptr;
  registry.view<const T>().each([&](Entity entity, const T& found) {
    if (!component || entity.bits < chosen.bits) {
      chosen = entity;
      component = &found;
    }
  });
  if (component) fn(*component);
}

}  // namespace

void extract_atmosphere(const Registry& registry, Frame& frame) {
  first_of<Sky>(registry, [&](const Sky& sky) {
    frame.sky = {sky.zenith_cd_m2, sky.horizon_cd_m2, sky.glow_height, sky.ambient};
  });
  first_of<Fog>(registry, [&](const Fog& fog) { frame.mist = {fog.extinction_per_km / 1000.0f, fog.albedo}; });
}

}  // namespace petrichor
