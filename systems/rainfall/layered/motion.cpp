#include "systems/rainfall/layered/motion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <utility>

#include "components/view.hpp"
#include "systems/first_of.hpp"
#include "systems/drops/drop_sizes.hpp"
#include "systems/rainfall/extract.hpp"

namespace petrichor {
namespace {

constexpr double least_speed_mps = 0.02;  // below it the way is not known
const glm::dvec3 down(0.0, -1.0, 0.0);

double wrapped(double metres) {
  return metres - layered_wrap_m * std::floor(metres / layered_wrap_m);
}

// How much drops of a size add to what is seen to move: the variance of the picture goes with D^4.
double seen_weight(double drops_per_m3, double diameter_mm) {
  return drops_per_m3 * diameter_mm * diameter_mm * diameter_mm * diameter_mm;
}

bool same_sizes(const Emitter& a, const Emitter& b) {
  return a.rain_mm_per_hour == b.rain_mm_per_hour && a.drop_sizes == b.drop_sizes && a.gamma_shape == b.gamma_shape &&
         a.minimum_diameter_mm == b.minimum_diameter_mm && a.maximum_diameter_mm == b.maximum_diameter_mm;
}

void set_artist(FrameLayered& layered, const LayeredComposite& settings, const FrameRain& rain, double time_s) {
  layered.published = settings.published;
  layered.strength = settings.strength;
  layered.milk = settings.milk;
  layered.parallax = settings.parallax;
  // l_b = 1 + k_c (L_1 + L_2), "Rain and lightning flashes".
  layered.lightning = settings.rain_contrast * (settings.lightning_1 + settings.lightning_2);
  layered.direction_mps = layered_velocity(settings, rain);
  layered.time_s = time_s;
}

// Velocity of the camera over the last tick, as extract_camera has it.
glm::dvec3 camera_velocity(const Registry& registry, double step_s) {
  const auto camera = first_of<Camera>(registry, [](const Camera& c) { return c.active; });
  const auto* motion = camera ? registry.find<CameraMotion>(camera.entity) : nullptr;
  if (!motion || !motion->moving_known || !(step_s > 0.0)) return glm::dvec3(0.0);
  return (glm::dvec3(motion->position_m) - glm::dvec3(motion->previous_position_m)) / step_s;
}

void share_classes(LayeredMotion& motion, const Emitter& emitter) {
  motion.emitter = emitter;
  motion.shares.clear();
  double sum = 0.0;
  const auto classes = make_drop_classes(emitter);
  for (const DropClass& c : classes) sum += c.drawn ? seen_weight(c.drops_per_m3, c.diameter_mm) : 0.0;
  motion.fall_mps = 0.0;
  for (const DropClass& c : classes) {
    motion.shares.push_back(c.drawn && sum > 0.0 ? static_cast<float>(seen_weight(c.drops_per_m3, c.diameter_mm) / sum) : 0.0f);
    motion.fall_mps += motion.shares.back() * c.fall_speed_mps;
  }
}

}  // namespace

glm::dquat follow_way(const glm::dquat& turn, const glm::dvec3& velocity_mps) {
  const double speed = glm::length(velocity_mps);
  if (!(speed > least_speed_mps)) return turn;
  const glm::dvec3 from = turn * down, to = velocity_mps / speed;
  const double cosine = std::clamp(glm::dot(from, to), -1.0, 1.0);
  if (cosine < -0.999999) return glm::normalize(glm::angleAxis(M_PI, turn * glm::dvec3(1.0, 0.0, 0.0)) * turn);
  const glm::dvec3 axis = glm::cross(from, to);
  return glm::normalize(glm::dquat(1.0 + cosine, axis.x, axis.y, axis.z)) * turn;
}

glm::vec3 layered_velocity(const LayeredComposite& settings, const FrameRain& rain) {
  glm::dvec3 sum(0.0);
  double weight = 0.0;
  for (const RainClass& c : rain.classes) {
    if (!c.drawn) continue;
    const double w = seen_weight(c.drops_per_m3, c.diameter_mm);
    sum += w * glm::dvec3(c.velocity_mps);
    weight += w;
  }
  const glm::vec3 own = weight > 0.0 ? glm::vec3(sum / weight) : rain.mean_velocity_mps;
  return own * settings.speed + settings.direction;
}

FrameLayered make_frame_layered(const LayeredComposite& settings, const Frame& frame, double time_s) {
  FrameLayered layered;
  if (!frame.rain) return layered;
  set_artist(layered, settings, *frame.rain, time_s);
  const glm::dvec3 past = glm::dvec3(layered.direction_mps) - glm::dvec3(frame.camera.velocity_mps);
  layered.turn = glm::quat(follow_way(glm::dquat(1.0, 0.0, 0.0, 0.0), past));
  layered.speed_mps = static_cast<float>(glm::length(past));
  layered.travelled_m = wrapped(layered.speed_mps * time_s);
  return layered;
}

void simulate_layered(Registry& registry, double time_s) {
  const Entity entity = first_of<Emitter>(registry).entity;
  if (entity == null_entity) return;
  const Emitter& emitter = registry.get<Emitter>(entity);
  const RainMotion* rain = registry.find<RainMotion>(entity);
  if (!rain) return;
  if (!registry.find<LayeredMotion>(entity)) registry.emplace<LayeredMotion>(entity);
  LayeredMotion& motion = registry.get<LayeredMotion>(entity);
  if (motion.shares.empty() || !same_sizes(motion.emitter, emitter)) share_classes(motion, emitter);
  if (motion.shares.size() != rain->wind.answers.size()) return;  // the rain itself begins anew at this tick

  const LayeredComposite* found = registry.find<LayeredComposite>(entity);
  const LayeredComposite settings = found ? *found : LayeredComposite{};
  glm::dvec3 own(0.0, -motion.fall_mps, 0.0);
  for (std::size_t k = 0; k < motion.shares.size(); ++k)
    if (motion.shares[k] > 0.0f) own += double(motion.shares[k]) * drift_at(rain->wind, k, time_s).velocity_mps;
  const double step_s = motion.known ? time_s - motion.time_s : 0.0;
  const glm::dvec3 past =
      own * double(settings.speed) + glm::dvec3(settings.direction) - camera_velocity(registry, step_s);
  motion.turn = follow_way(motion.turn, past);
  motion.step_m = glm::length(past) * std::max(step_s, 0.0);
  motion.travelled_m = wrapped(motion.travelled_m + motion.step_m);
  motion.time_s = time_s;
  motion.known = true;
}

void extract_layered(const Registry& registry, Frame& frame, double time_s, double interpolation) {
  if (!frame.rain) return;
  const Entity entity = first_of<Emitter>(registry).entity;
  const LayeredComposite* found = entity == null_entity ? nullptr : registry.find<LayeredComposite>(entity);
  const LayeredComposite settings = found ? *found : LayeredComposite{};
  const LayeredMotion* motion = entity == null_entity ? nullptr : registry.find<LayeredMotion>(entity);
  FrameLayered& layered = frame.rain->layered;
  layered = make_frame_layered(settings, frame, time_s);
  if (!motion || !motion->known) return;
  // The way of this very frame; what was travelled is the ticks'.
  const glm::dvec3 past = glm::dvec3(layered.direction_mps) - glm::dvec3(frame.camera.velocity_mps);
  layered.turn = glm::quat(follow_way(motion->turn, past));
  layered.travelled_m = wrapped(motion->travelled_m - (1.0 - interpolation) * motion->step_m);
}

}  // namespace petrichor
