// The cone over time: from components to its track, and to the frame.
#include <algorithm>
#include <cmath>

#include "components/view.hpp"
#include "systems/first_of.hpp"
#include "systems/rainfall/cone/cone.hpp"
#include "systems/drops/drop_sizes.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/snow/extract.hpp"
#include "systems/rainfall/snow/flakes.hpp"

namespace petrichor {
namespace {

// Whose entity carries the cone and its settings.
struct Source {
  Entity entity = null_entity;
  First<Emitter> rain;
  First<Snowfall> snow;
  DoubleCone set;
  explicit operator bool() const { return rain || snow; }
};
Source source_of(const Registry& registry) {
  Source s;
  s.rain = first_of<Emitter>(registry);
  s.snow = first_snowfall(registry);
  s.entity = s.rain ? s.rain.entity : s.snow.entity;
  if (s)
    if (const DoubleCone* set = registry.find<DoubleCone>(s.entity)) s.set = *set;
  return s;
}

// The mean fall by extinction, solved again only where the emitter's settings have changed.
void know_fall(ConeMotion& m, const Emitter& e) {
  if (m.rate == e.rain_mm_per_hour && m.drop_sizes == e.drop_sizes && m.gamma_shape == e.gamma_shape &&
      m.minimum_mm == e.minimum_diameter_mm && m.maximum_mm == e.maximum_diameter_mm)
    return;
  m.rate = e.rain_mm_per_hour, m.drop_sizes = e.drop_sizes, m.gamma_shape = e.gamma_shape;
  m.minimum_mm = e.minimum_diameter_mm, m.maximum_mm = e.maximum_diameter_mm;
  const auto classes = make_drop_classes(e);
  double sum = 0.0, fall = 0.0;
  for (const DropClass& c : classes)
    if (c.drawn) sum += extinction_per_m(c), fall += extinction_per_m(c) * c.fall_speed_mps;
  if (sum > 0.0) m.fall_mps = fall / sum;
  m.wind_class = 0;
  for (std::size_t k = 0; k < classes.size(); ++k)
    if (std::abs(classes[k].fall_speed_mps - m.fall_mps) < std::abs(classes[m.wind_class].fall_speed_mps - m.fall_mps))
      m.wind_class = k;
}

ConeFlow rain_flow(const ConeMotion& m, const RainMotion& rain, const Emitter& e, float exposure_s, double time_s) {
  ConeFlow flow;
  const std::size_t k = std::min(m.wind_class, rain.wind.answers.size() - 1);
  flow.velocity_mps = glm::vec3(drift_at(rain.wind, k, time_s).velocity_mps - glm::dvec3(0.0, m.fall_mps, 0.0));
  flow.camera_mps = m.camera_mps;
  flow.exposure_s = exposure_s;
  flow.mm_per_hour = e.rain_mm_per_hour;
  return flow;
}

ConeFlow snow_flow(const ConeMotion& m, const SnowMotion& snow, const Snowfall& s, float exposure_s, double time_s) {
  ConeFlow flow;
  const std::size_t k = snow.wind.answers.size() / 2;
  static const double fall = cone_means(ConeTexture::snow_coarse).speed_mps;
  flow.velocity_mps = glm::vec3(drift_at(snow.wind, k, time_s).velocity_mps - glm::dvec3(0.0, fall, 0.0));
  flow.camera_mps = m.camera_mps;
  flow.exposure_s = exposure_s;
  flow.mm_per_hour = s.snow_mm_per_hour;
  flow.snow = true;
  return flow;
}

// Only where they are drawn: who never draws a cone pays for none. Then both that the rate decides between, so that a
// rate which changes has nothing to wait for.
void prepare(const DoubleCone& set, float share, bool snow) {
  if (!(share > 0.0f)) return;
  for (const float least_or_most : {0.0f, 1000.0f})
    shared_cone_textures(cone_kinds(set.texture, least_or_most, snow).first);
}

}  // namespace

void simulate_cone(Registry& registry, double time_s, double step_s) {
  const Source source = source_of(registry);
  if (!source) return;
  ConeMotion* motion = registry.find<ConeMotion>(source.entity);
  if (!motion) motion = &registry.emplace<ConeMotion>(source.entity);
  float exposure_s = 1.0f / 60.0f;
  if (const auto camera = first_of<Camera>(registry, [](const Camera& c) { return c.active; })) {
    exposure_s = camera->exposure_s;
    const auto* tracked = registry.find<CameraMotion>(camera.entity);
    if (tracked && tracked->moving_known && step_s > 0.0)
      motion->camera_mps = (tracked->position_m - tracked->previous_position_m) / static_cast<float>(step_s);
  }
  if (source.rain) {
    know_fall(*motion, *source.rain);
    const RainMotion* rain = registry.find<RainMotion>(source.entity);
    if (rain && !rain->wind.answers.empty())
      advance_cone(motion->rain, source.set, rain_flow(*motion, *rain, *source.rain, exposure_s, time_s), time_s);
  }
  if (source.snow) {
    const SnowMotion* snow = registry.find<SnowMotion>(source.snow.entity);
    if (snow && !snow->wind.answers.empty())
      advance_cone(motion->snow, source.set, snow_flow(*motion, *snow, *source.snow, exposure_s, time_s), time_s);
  }
}

void extract_cone(const Registry& registry, Frame& frame, double time_s) {
  const Source source = source_of(registry);
  if (frame.rain) prepare(source.set, frame.rain->share(RainRung::double_cone), false);
  if (frame.snow) prepare(source.set, frame.snow->share(SnowRung::double_cone), true);
  const FrameCamera& camera = frame.camera;
  const auto* motion = source ? registry.find<ConeMotion>(source.entity) : nullptr;
  if (frame.rain) {
    if (motion && motion->rain.time_s >= 0.0) {
      ConeFlow flow;
      flow.exposure_s = camera.exposure_s;
      flow.mm_per_hour = frame.rain->rain_mm_per_hour;
      frame.rain->cone =
          frame_cone(motion->rain, source.set, flow, camera.angular_velocity_radps, frame.step_s, time_s);
      update_onsets(*frame.rain);
    } else {
      set_cone(*frame.rain, source.set, camera, frame.step_s, time_s);
    }
  }
  if (frame.snow) {
    if (motion && motion->snow.time_s >= 0.0) {
      ConeFlow flow;
      flow.exposure_s = camera.exposure_s;
      flow.mm_per_hour = frame.snow->snow_mm_per_hour;
      flow.snow = true;
      frame.snow->cone =
          frame_cone(motion->snow, source.set, flow, camera.angular_velocity_radps, frame.step_s, time_s);
      update_onsets(*frame.snow);
    } else {
      set_cone(*frame.snow, source.set, camera, frame.step_s, time_s);
    }
  }
}

}  // namespace petrichor
