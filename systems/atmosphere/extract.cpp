#include "systems/atmosphere/extract.hpp"

#include "components/weather.hpp"
#include "systems/first_of.hpp"

namespace petrichor {

void extract_atmosphere(const Registry& registry, Frame& frame) {
  if (const auto sky = first_of<Sky>(registry))
    frame.sky = {sky->zenith_cd_m2, sky->horizon_cd_m2, sky->glow_height, sky->ambient};
  if (const auto fog = first_of<Fog>(registry)) frame.mist = {fog->extinction_per_km / 1000.0f, fog->albedo};
}

}  // namespace petrichor
