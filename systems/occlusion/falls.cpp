#include "systems/occlusion/falls.hpp"

#include <algorithm>
#include <cmath>

#include "systems/wind_motion.hpp"

namespace petrichor {
namespace {

constexpr float gravity_mps2 = 9.81f;
constexpr int gust_samples = 64;
constexpr double sample_step_periods = 2.6457513111;  // no period of a gust's waves fits in it a whole number of times
constexpr float least_fall_mps = 0.1f;

struct Falling {
  float fall_speed_mps;
  glm::vec3 velocity_mps;
  float water, drops;  // fluxes; each sums to the mm/h, and to 1
};

std::vector<Falling> falling(const Frame& frame) {
  std::vector<Falling> all;
  const auto add = [&](auto water_of, auto number_of, const auto& classes, float mm_per_hour) {
    const std::size_t first = all.size();
    float water = 0.0f;
    for (const auto& c : classes) {
      all.push_back(
          {c.fall_speed_mps, c.velocity_mps, water_of(c) * c.fall_speed_mps, number_of(c) * c.fall_speed_mps});
      water += all.back().water;
    }
    for (std::size_t i = first; i < all.size(); ++i) all[i].water *= water > 0.0f ? mm_per_hour / water : 0.0f;
  };
  if (frame.rain && frame.rain->rain_mm_per_hour > 0.0f)
    add([](const RainClass& c) { return c.drops_per_m3 * c.diameter_mm * c.diameter_mm * c.diameter_mm; },
        [](const RainClass& c) { return c.drawn ? c.drops_per_m3 : 0.0f; }, frame.rain->classes,
        frame.rain->rain_mm_per_hour);
  if (frame.snow && frame.snow->snow_mm_per_hour > 0.0f)  // mass 0.073 D^1.4 mg (shared physics, section 12)
    add([](const SnowClass& c) { return c.flakes_per_m3 * std::pow(c.diameter_mm, 1.4f); },
        [](const SnowClass& c) { return c.flakes_per_m3; }, frame.snow->classes, frame.snow->snow_mm_per_hour);
  float drops = 0.0f;
  for (const Falling& f : all) drops += f.drops;
  for (Falling& f : all) f.drops *= drops > 0.0f ? 1.0f / drops : 0.0f;
  return all;
}

struct Sample {
  glm::vec2 tilt;  // level metres per metre of fall, x along the mean wind and y across
  float weight, water;
};

// Cuts what is sorted into `count` parts of equal weight and calls with each part's first and last sample and water.
template <class Part>
void cut(const std::vector<Sample>& samples, float total, int count, Part part) {
  std::size_t at = 0;
  float before = 0.0f;
  for (int i = 0; i < count; ++i) {
    const std::size_t first = at;
    const float end = total * static_cast<float>(i + 1) / static_cast<float>(count);
    while (at < samples.size() && (i + 1 == count || before + 0.5f * samples[at].weight < end))
      before += samples[at++].weight;
    if (at > first) part(i, first, at);
  }
}

}  // namespace

bool precipitates(const Frame& frame) {
  return (frame.rain && frame.rain->rain_mm_per_hour > 0.0f) || (frame.snow && frame.snow->snow_mm_per_hour > 0.0f);
}

glm::vec3 mean_fall(const Frame& frame) {
  if (frame.wind) {
    float water = 0.0f, falls = 0.0f;
    for (const Falling& f : falling(frame)) water += f.water, falls += f.water * f.fall_speed_mps;
    if (water > 0.0f) return frame.wind->velocity_mps - glm::vec3(0.0f, falls / water, 0.0f);
  }
  const float rain = frame.rain ? frame.rain->rain_mm_per_hour : 0.0f;
  const float snow = frame.snow ? frame.snow->snow_mm_per_hour : 0.0f;
  glm::vec3 sum(0.0f);
  if (rain > 0.0f) sum += rain * frame.rain->mean_velocity_mps;
  if (snow > 0.0f) sum += snow * frame.snow->mean_velocity_mps;
  return sum.y < 0.0f ? sum / (rain + snow) : glm::vec3(0.0f, -1.0f, 0.0f);
}

std::vector<FallShare> chosen_falls(const Frame& frame, int count) {
  const std::vector<Falling> all = falling(frame);
  std::vector<Sample> samples;
  float total = 0.0f, water = 0.0f;
  glm::vec2 mean(0.0f);
  const auto add = [&](const glm::vec3& velocity, const Falling& f, float rate, float share) {
    const glm::vec2 tilt = glm::vec2(velocity.x, velocity.z) / std::max(-velocity.y, least_fall_mps);
    const Sample s{tilt, 0.5f * (f.water / rate + f.drops) * share, f.water / rate * share};
    if (!(s.weight > 0.0f)) return;
    samples.push_back(s);
    total += s.weight;
    water += s.water;
    mean += s.water * tilt;
  };
  float rate = 0.0f;
  for (const Falling& f : all) rate += f.water;
  if (!(rate > 0.0f) || count < 1) return {{mean_fall(frame), 1.0f}};
  if (frame.wind) {
    std::vector<double> responses;
    for (const Falling& f : all) responses.push_back(f.fall_speed_mps / gravity_mps2);
    const WindMotion motion = start_wind_motion(*frame.wind, responses);
    const int moments = frame.wind->gust_mps != 0.0f || frame.wind->swirl_mps != 0.0f ? gust_samples : 1;
    for (std::size_t k = 0; k < all.size(); ++k) {
      for (int j = 0; j < moments; ++j) {
        const double time_s = (j + 0.5) * sample_step_periods * frame.wind->gust_period_s;
        const glm::vec3 wind =
            moments > 1 ? glm::vec3(drift_at(motion, k, time_s).velocity_mps) : frame.wind->velocity_mps;
        add(wind - glm::vec3(0.0f, all[k].fall_speed_mps, 0.0f), all[k], rate, 1.0f / static_cast<float>(moments));
      }
    }
  } else {
    for (const Falling& f : all) add(f.velocity_mps, f, rate, 1.0f);
  }
  const glm::vec2 along = glm::length(mean) > 1e-6f * water ? glm::normalize(mean) : glm::vec2(1.0f, 0.0f);
  const glm::vec2 across(-along.y, along.x);
  for (Sample& s : samples) s.tilt = {glm::dot(s.tilt, along), glm::dot(s.tilt, across)};
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.tilt.x < b.tilt.x; });
  std::vector<FallShare> falls;
  cut(samples, total, count, [&](int i, std::size_t first, std::size_t end) {
    float weight = 0.0f, part_water = 0.0f;
    for (std::size_t j = first; j < end; ++j) weight += samples[j].weight, part_water += samples[j].water;
    std::size_t middle = first;
    for (float sum = 0.5f * samples[first].weight; middle + 1 < end && sum < 0.5f * weight; ++middle)
      sum += 0.5f * (samples[middle].weight + samples[middle + 1].weight);
    const float tilt = samples[middle].tilt.x;
    // Across: another quantile in every group, by the golden ratio and in pairs of neighbours, one to either side.
    std::vector<Sample> group(samples.begin() + static_cast<std::ptrdiff_t>(first),
                              samples.begin() + static_cast<std::ptrdiff_t>(end));
    std::stable_sort(group.begin(), group.end(), [](const Sample& a, const Sample& b) { return a.tilt.y < b.tilt.y; });
    const double part_of_pair = std::fmod((i / 2 + 0.5) * 0.6180339887, 1.0);
    const double quantile = i + 1 == count && count % 2 == 1 ? 0.5 : i % 2 == 0 ? part_of_pair : 1.0 - part_of_pair;
    float sum = 0.0f;
    std::size_t at = 0;
    for (; at + 1 < group.size(); ++at)
      if ((sum += group[at].weight) >= quantile * weight) break;
    const glm::vec2 level = tilt * along + group[at].tilt.y * across;
    falls.push_back({{level.x, -1.0f, level.y}, part_water / water});
  });
  return falls;
}

}  // namespace petrichor
