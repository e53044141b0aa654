#include "systems/frame_gpu.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "systems/frustum.hpp"
#include "systems/gpu_scene.hpp"

namespace petrichor {
namespace {

// clip = (f x / aspect, f y, near, -z): never loses precision far away.
glm::dmat4 projection(double vertical_fov_rad, double aspect, double near_m) {
  const double f = 1.0 / std::tan(0.5 * vertical_fov_rad);
  glm::dmat4 p(0.0);
  p[0][0] = f / aspect;
  p[1][1] = f;
  p[2][3] = -1.0;
  p[3][2] = near_m;
  return p;
}

glm::dmat4 inverse_projection(double vertical_fov_rad, double aspect, double near_m) {
  const double f = 1.0 / std::tan(0.5 * vertical_fov_rad);
  glm::dmat4 p(0.0);
  p[0][0] = aspect / f;
  p[1][1] = 1.0 / f;
  p[2][3] = 1.0 / near_m;
  p[3][2] = -1.0;
  return p;
}

}  // namespace

glm::mat4 view_projection_of(const glm::quat& orientation, float vertical_fov_rad, float aspect, float near_m) {
  const glm::dmat4 view = glm::mat4_cast(glm::conjugate(glm::normalize(glm::dquat(orientation))));
  return glm::mat4(projection(vertical_fov_rad, aspect, near_m) * view);
}

float exposure_scale(float ev100) {
  return 1.0f / (1.2f * std::exp2(ev100));
}

void finish_frame(Frame& frame) {
  const FrameCamera& c = frame.camera;
  const float width = static_cast<float>(std::max(frame.width, 1)),
              height = static_cast<float>(std::max(frame.height, 1));
  const float aspect = width / height;
  const float tangent = std::tan(0.5f * c.vertical_fov_rad);
  const glm::dquat orientation = glm::normalize(glm::dquat(c.orientation));
  const glm::dmat4 back = glm::mat4_cast(orientation);

  FrameUniforms& u = frame.uniforms;
  u.view = glm::mat4(glm::transpose(back));
  u.view_projection = glm::mat4(projection(c.vertical_fov_rad, aspect, c.near_m) * glm::transpose(back));
  u.inverse_view_projection = glm::mat4(back * inverse_projection(c.vertical_fov_rad, aspect, c.near_m));

  // The camera when the shutter opened: turned back by angular velocity x exposure, moved back by velocity x exposure.
  const glm::dvec3 turn = glm::dvec3(c.angular_velocity_radps) * static_cast<double>(c.exposure_s);
  const double angle = glm::length(turn);
  const glm::dquat then = angle > 1e-12 ? glm::angleAxis(-angle, turn / angle) * orientation : orientation;
  glm::dmat4 shift(1.0);
  shift[3] = glm::dvec4(glm::dvec3(c.velocity_mps) * static_cast<double>(c.exposure_s), 1.0);
  u.shutter_view_projection =
      glm::mat4(projection(c.vertical_fov_rad, aspect, c.near_m) * glm::transpose(glm::mat4_cast(then)) * shift);

  u.camera_world_m = {glm::vec3(c.position_m), c.near_m};
  u.camera_velocity_mps = {c.velocity_mps, c.exposure_s};
  u.size = {width, height, 1.0f / width, 1.0f / height};
  u.lens = {tangent, aspect, 0.5f * height / tangent, exposure_scale(c.exposure_ev100)};
  u.time = {static_cast<float>(std::fmod(frame.time_s, 3600.0)), static_cast<float>(frame.number & 0xfffffu), u.time.z,
            0.0f};
  u.sky_zenith = {frame.sky.zenith_cd_m2, frame.sky.ambient};
  u.sky_horizon = {frame.sky.horizon_cd_m2, frame.sky.glow_height};
  u.mist = {frame.mist.extinction_per_m, frame.mist.albedo};
  static_assert(RAIN_ONSET_PAIRS == (rain_onsets + snow_onsets) / 2 && rain_onsets % 2 == 0);
  u.rain = glm::vec4(0.0f);
  u.counts.z = 0;
  for (glm::vec4& onsets : u.rain_onsets) onsets = glm::vec4(0.0f);
  if (frame.rain && frame.rain->rain_mm_per_hour > 0.0f) {
    update_onsets(*frame.rain);
    u.rain = rain_uniform(*frame.rain);
    for (int i = 0; i < rain_onsets; ++i) {
      const RainOnset& o = frame.rain->onsets[i];
      u.rain_onsets[i / 2][2 * (i % 2)] = o.extinction_per_m;
      u.rain_onsets[i / 2][2 * (i % 2) + 1] = o.onset_m;
    }
    u.counts.z = rain_onsets / 2;
  }
  if (frame.snow && frame.snow->snow_mm_per_hour > 0.0f) {
    update_onsets(*frame.snow);
    glm::vec2 sum(u.rain.x, u.rain.x * u.rain.y);
    for (int i = 0; i < snow_onsets; ++i) {
      const RainOnset& o = frame.snow->onsets[i];
      u.rain_onsets[(rain_onsets + i) / 2][2 * (i % 2)] = o.extinction_per_m;
      u.rain_onsets[(rain_onsets + i) / 2][2 * (i % 2) + 1] = o.onset_m;
      sum += glm::vec2(o.extinction_per_m, o.extinction_per_m * o.onset_m);
    }
    u.counts.z = (rain_onsets + snow_onsets) / 2;
    u.rain = {sum.x, sum.x > 0.0f ? sum.y / sum.x : 0.0f, u.rain.z + frame.snow->fog_extinction_per_m, u.rain.w};
  }
  u.counts = {0, static_cast<std::uint32_t>(frame.instances.size()), u.counts.z, 0};
  u.counts.x = static_cast<std::uint32_t>(visible_lights(frame).size());
}

float light_range_m(const FrameLight& light, float ev100) {
  if (light.range_m > 0.0f) return light.range_m;
  if (light.kind == LIGHT_DIRECTIONAL) return 1e9f;
  const float strongest = std::max({light.intensity.x, light.intensity.y, light.intensity.z, 0.0f});
  // A white Lambertian wall under E lux shows E/pi cd/m2.
  const float least_lux = visible_share * 3.14159265f / exposure_scale(ev100);
  return std::clamp(std::sqrt(strongest / least_lux), 0.1f, 1e6f);
}

std::vector<LightGpu> visible_lights(const Frame& frame) {
  const Frustum frustum = frustum_of(frame.uniforms.view_projection);
  std::vector<LightGpu> lights;
  std::vector<float> weight;
  for (const FrameLight& light : frame.lights) {
    const float range = light_range_m(light, frame.camera.exposure_ev100);
    const glm::vec3 position(glm::dvec3(light.position_m) - frame.camera.position_m);
    const float strongest = std::max({light.intensity.x, light.intensity.y, light.intensity.z});
    if (!(strongest > 0.0f)) continue;
    const bool directional = light.kind == LIGHT_DIRECTIONAL;
    if (!directional && !sphere_touches(frustum, position, range)) continue;
    // KHR_lights_punctual's cone: clamp(scale * cos + offset, 0, 1)^2.
    const float inner = std::cos(std::min(light.inner_cone_rad, light.outer_cone_rad));
    const float outer = std::cos(light.outer_cone_rad);
    const float scale = light.kind == LIGHT_SPOT ? 1.0f / std::max(0.001f, inner - outer) : 0.0f;
    const float offset = light.kind == LIGHT_SPOT ? -outer * scale : 1.0f;
    lights.push_back(
        {glm::vec4(position, range), glm::vec4(light.intensity, light.source_radius_m),
         glm::vec4(light.direction, static_cast<float>(light.kind)),
         glm::vec4(scale, offset, static_cast<float>(light.shadow_slot), light.lights_rain ? 1.0f : 0.0f)});
    weight.push_back(directional ? 1e30f : strongest / std::max(glm::dot(position, position), 1.0f));
  }
  std::vector<std::size_t> order(lights.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return weight[a] > weight[b]; });
  std::vector<LightGpu> sorted;
  for (const std::size_t i : order) sorted.push_back(lights[i]);
  return sorted;
}

void FrameGpu::upload(const Frame& frame) {
  const std::vector<LightGpu> lights = visible_lights(frame);
  petrichor::upload(uniforms_, &frame.uniforms, sizeof(FrameUniforms));
  glBindBufferRange(GL_UNIFORM_BUFFER, FRAME_UNIFORMS_BINDING, uniforms_.id, 0, sizeof(FrameUniforms));
  // An empty buffer cannot be bound: without lights one dark one stands there, not counted.
  const LightGpu dark{};
  if (lights.empty()) petrichor::upload(lights_, &dark, sizeof dark);
  petrichor::upload(lights_, std::span<const LightGpu>(lights));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, LIGHTS_BINDING, lights_.id);
  if (frame.scene) upload_instances(*frame.scene, frame);
}

}  // namespace petrichor
