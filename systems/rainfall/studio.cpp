#include "systems/rainfall/studio.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/rainfall/extract.hpp"
#include "systems/systems.hpp"

namespace petrichor {
namespace {

constexpr double tick_s = 1.0 / 120.0;
constexpr int block = 8;      // pixels: statistics are pooled over blocks, or a few pictures would be too few
constexpr int rings = 5, wedges = 8;

glm::vec3 camera_at(const StudioScene& scene, double time_s) {
  return glm::vec3(0.0f, 1.7f, 0.0f) + scene.camera_velocity_mps * static_cast<float>(time_s);
}

double rms(const Picture& a, const Picture& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += double(a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

double average(const Picture& a) {
  double sum = 0.0;
  for (const float v : a) sum += v;
  return sum / static_cast<double>(a.size());
}

// Adds the power of a residual to rings (by octaves of frequency) and wedges (by direction).
void add_power(std::vector<double>& spectrum, const std::vector<double>& residual, int width, int height) {
  const int half = width / 2 + 1;
  std::vector<double> input = residual;
  auto* output = fftw_alloc_complex(std::size_t(half) * height);
  fftw_plan plan = fftw_plan_dft_r2c_2d(height, width, input.data(), output, FFTW_ESTIMATE);
  fftw_execute(plan);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < half; ++x) {
      const double fy = double(y <= height / 2 ? y : y - height) / height, fx = double(x) / width;
      const double f = std::hypot(fx, fy);
      if (f < 1.0 / 64.0) continue;  // the mean's business
      const int ring = std::clamp(static_cast<int>(std::floor(std::log2(f * 64.0))), 0, rings - 1);
      double angle = std::atan2(fy, fx) / std::numbers::pi + 1.0 + 0.5 / wedges;
      angle -= std::floor(angle);
      const int wedge = std::min(static_cast<int>(angle * wedges), wedges - 1);
      const double power = output[std::size_t(y) * half + x][0] * output[std::size_t(y) * half + x][0] +
                           output[std::size_t(y) * half + x][1] * output[std::size_t(y) * half + x][1];
      spectrum[std::size_t(ring) * wedges + wedge] += x == 0 || 2 * x == width ? power : 2.0 * power;
    }
  fftw_destroy_plan(plan);
  fftw_free(output);
}

}  // namespace

StudioScene day_street() {
  StudioScene s;
  s.name = "day";
  s.title = "day street, 10 mm/h";
  s.wind.velocity_mps = {1.5f, 0.0f, 0.0f};
  s.wall_cd_m2 = glm::vec3(300.0f);  // grey fronts under an overcast sky
  s.sky_cd_m2 = 2000.0f;
  s.exposure_ev100 = 10.0f;
  return s;
}

StudioScene night_lamps() {
  StudioScene s;
  s.name = "night";
  s.title = "night lamps, 10 mm/h";
  s.wind.velocity_mps = {1.5f, 0.0f, 0.0f};
  s.lamps_m = {{-2.5f, 1.3f, -9.0f}, {2.0f, 2.3f, -14.0f}, {0.5f, 0.3f, -17.0f}};
  return s;
}

StudioScene storm() {
  StudioScene s;
  s.name = "storm";
  s.title = "storm, 50 mm/h, wind 8 m/s, walking";
  s.rain_mm_per_hour = 50.0f;
  s.wind.velocity_mps = {8.0f, 0.0f, 0.0f};
  s.wind.gust_mps = 3.0f;
  s.camera_velocity_mps = {0.0f, 0.0f, -1.5f};
  s.wall_distance_m = 14.0f;
  s.lamps_m = {{-2.5f, 1.3f, -9.0f}, {2.0f, 2.3f, -12.0f}};
  return s;
}

Statistics statistics_of(const std::vector<Picture>& images, int width, int height) {
  Statistics s;
  const int across = width / block, up = height / block;
  s.mean.assign(std::size_t(across) * up, 0.0f);
  s.deviation = s.mean;
  const double count = static_cast<double>(images.size());
  Picture mean(images.front().size(), 0.0f);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = std::size_t(y) * width + x;
      double sum = 0.0, squares = 0.0;
      for (const Picture& image : images) {
        sum += image[pixel];
        squares += double(image[pixel]) * image[pixel];
      }
      mean[pixel] = static_cast<float>(sum / count);
      if (x >= across * block || y >= up * block) continue;
      const double variance = std::max(0.0, (squares - sum * sum / count) / (count - 1.0));
      const std::size_t at = std::size_t(y / block) * across + x / block;
      s.mean[at] += static_cast<float>(sum / count / (block * block));
      s.deviation[at] += static_cast<float>(variance / (block * block));
    }
  }
  for (float& v : s.deviation) v = std::sqrt(v);

  s.spectrum.assign(std::size_t(rings) * wedges, 0.0);
  std::vector<double> residual(mean.size());
  for (const Picture& image : images) {
    for (std::size_t i = 0; i < mean.size(); ++i) residual[i] = double(image[i]) - mean[i];
    add_power(s.spectrum, residual, width, height);
  }
  double total = 0.0;
  for (const double power : s.spectrum) total += power;
  // Rounding of half floats is no rain: less than that is nothing.
  const double least = 1e-9 * average(mean) * average(mean) * double(mean.size()) * double(mean.size()) * count;
  if (total <= least)
    s.spectrum.clear();
  else
    for (double& power : s.spectrum) power /= total;
  return s;
}

StatisticsError compare(const Statistics& found, const Statistics& truth, const Statistics& dry) {
  StatisticsError e;
  const double off = rms(dry.mean, truth.mean) + rms(dry.deviation, truth.deviation);
  e.mean = rms(found.mean, truth.mean) / off;
  e.deviation = rms(found.deviation, truth.deviation) / off;
  e.spectrum = found.spectrum.empty() ? 1.0 : 0.0;
  if (!found.spectrum.empty())
    for (std::size_t i = 0; i < truth.spectrum.size(); ++i)
      e.spectrum += 0.5 * std::abs(found.spectrum[i] - truth.spectrum[i]);
  e.all = 0.5 * (e.mean + e.deviation) + 0.5 * e.spectrum;
  e.mean_shift = (average(found.mean) - average(truth.mean)) / average(dry.mean);
  return e;
}

Result<std::unique_ptr<Studio>> Studio::make(bool software, const StudioScene& scene, int width, int height) {
  std::unique_ptr<Studio> studio(new Studio);
  studio->scene_ = scene;
  studio->software_ = software;
  studio->width_ = width ? width : software ? 240 : 640;
  studio->height_ = height ? height : software ? 136 : 360;
  StageSet set;
  set.present = false;
  set.wall_cd_m2 = scene.wall_cd_m2;
  set.wall_distance_m = scene.wall_distance_m;
  set.wall_hides = true;
  set.flakes = scene.snow_mm_per_hour > 0.0f;
  auto stage = RainStage::make(software, set);
  if (!stage) return tl::unexpected(stage.error());
  studio->stage_ = std::move(*stage);
  studio->begin(studio->cast());
  return studio;
}

Studio::Cast Studio::cast() const {
  Cast cast;
  cast.emitter.rain_mm_per_hour = scene_.rain_mm_per_hour;
  cast.emitter.drawn_distance_m = 25.0f;
  cast.emitter.maximum_drops = 400'000'000;
  cast.snowfall.snow_mm_per_hour = scene_.snow_mm_per_hour;
  cast.snowfall.drawn_distance_m = 25.0f;
  cast.snowfall.maximum_flakes = 400'000'000;
  return cast;
}

void Studio::begin(const Cast& cast) {
  registry_ = Registry();
  schedule_ = std::make_unique<Schedule<SystemContext>>(all_systems(), component_schemas());
  techniques_ = cast.techniques;
  tick_ = -1;
  last_s_ = -1.0;
  weather_ = registry_.create();
  registry_.emplace<Emitter>(weather_, cast.emitter);
  registry_.emplace<Wind>(weather_, scene_.wind);
  registry_.emplace<DoubleCone>(weather_, cast.cone);
  registry_.emplace<LayeredComposite>(weather_, cast.layered);
  registry_.emplace<StreakSprites>(weather_, cast.sprites);
  registry_.emplace<Snowfall>(weather_, cast.snowfall);
  camera_ = registry_.create();
  Camera camera;
  camera.vertical_fov_deg = 30.0f;
  camera.exposure_ev100 = scene_.exposure_ev100;
  registry_.emplace<Camera>(camera_, camera);
  registry_.emplace<Transform>(camera_, Transform{camera_at(scene_, 0.0)});
}

Frame Studio::frame(double time_s) {
  SystemContext context{registry_, commands_, 0.0, tick_s, 1.0, {}, no_models_};
  context.advance_script = [](double) { return Result<void>(); };
  const auto last = static_cast<std::int64_t>(std::ceil(time_s / tick_s - 1e-6));
  while (tick_ < last) {
    ++tick_;
    context.time_s = static_cast<double>(tick_) * tick_s;
    registry_.get<Transform>(camera_).position_m = camera_at(scene_, context.time_s);
    schedule_->run(context, registry_, commands_, Phase::input, Phase::propagate);
  }
  Frame f = stage_frame(width_, height_);
  f.number = ++number_;
  f.time_s = time_s;
  // Moments are frames of one film; nobody drew those between them.
  if (last_s_ >= 0.0 && time_s > last_s_) f.step_s = static_cast<float>(std::min(time_s - last_s_, 1.0 / 60.0));
  last_s_ = time_s;
  f.techniques = techniques_;
  context.time_s = time_s;
  context.interpolation = std::clamp(1.0 - (static_cast<double>(tick_) - time_s / tick_s), 0.0, 1.0);
  context.frame = &f;
  f.sky.zenith_cd_m2 = f.sky.horizon_cd_m2 = glm::vec3(scene_.sky_cd_m2);
  schedule_->run(context, registry_, commands_, Phase::extract, Phase::extract);
  for (const glm::vec3& at : scene_.lamps_m) {
    FrameLight light{};
    // Lamps go with the camera, so that pictures of all moments are of one place.
    light.position_m = glm::vec3(f.camera.position_m) + at;
    light.direction = {0.0f, -1.0f, 0.0f};
    light.intensity = scene_.lamp_cd;
    light.source_radius_m = 0.08f;
    light.kind = LIGHT_POINT;
    light.lights_rain = true;
    f.lights.push_back(light);
  }
  return f;
}

Result<Picture> Studio::draw(Frame& f) {
  if (auto drawn = stage_->draw(f); !drawn) return tl::unexpected(drawn.error());
  const std::vector<float> light = stage_->read_light();
  Picture image(light.size() / 4);
  for (std::size_t i = 0; i < image.size(); ++i)
    image[i] = (0.2126f * light[4 * i] + 0.7152f * light[4 * i + 1] + 0.0722f * light[4 * i + 2]) * f.uniforms.lens.w;
  return image;
}

Result<std::vector<Timing>> Studio::time_passes(Frame& f) {
  FrameTimer& timer = stage_->timer();
  timer.begin_frame(true);
  const auto drawn = stage_->draw(f);
  timer.end_frame();
  if (!drawn) return tl::unexpected(drawn.error());
  glFinish();
  std::vector<Timing> rain;
  for (Timing& timing : timer.collect())
    if (timing.name.rfind("stage_", 0) != 0) rain.push_back(std::move(timing));
  return rain;
}

Result<double> Studio::time(Frame& f) {
  const auto timings = time_passes(f);
  if (!timings) return tl::unexpected(timings.error());
  double sum = 0.0;
  for (const Timing& timing : *timings) sum += timing.milliseconds;
  return sum;
}

Result<Picture> Studio::truth(double time_s, std::uint32_t seed) {
  Picture sum;
  Emitter emitter = cast().emitter;
  emitter.seed = seed;
  const WindMotion wind = start_rain_motion(emitter, scene_.wind);
  const int instants = truth_instants();
  for (int i = 0; i < instants; ++i) {
    Frame f = frame(time_s);
    const double earlier = f.camera.exposure_s * (i + 0.5) / instants;
    const glm::vec3 back = f.camera.velocity_mps * static_cast<float>(earlier);
    f.camera.position_m -= glm::dvec3(back);
    for (FrameLight& light : f.lights) light.position_m -= back;
    f.camera.exposure_s = 0.0f;
    f.rain = make_frame_rain(emitter, wind, f.camera, width_, height_, time_s - earlier);
    f.rain->techniques = Techniques();
    f.rain->techniques.set(Effect::streaks, StreakRung::even);
    f.techniques = f.rain->techniques;
    f.rain->fade_start_m = 1.2f * scene_.wall_distance_m;  // beyond the wall's corners: nothing is left to fog
    f.rain->drawn_distance_m = 1.21f * scene_.wall_distance_m;
    auto image = draw(f);
    if (!image) return image;
    if (sum.empty()) sum.assign(image->size(), 0.0f);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += (*image)[k] / static_cast<float>(instants);
  }
  return sum;
}

}  // namespace petrichor
