#include "systems/rainfall/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "engine/core/bench_row.hpp"
#include "engine/core/log.hpp"
#include "engine/core/paths.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/passes.hpp"
#include "systems/rainfall/stage.hpp"

namespace petrichor {
namespace {

constexpr float wall_m = 20.0f;
constexpr int instants = 64;  // of the truth's exposure
constexpr int moments = 6;    // pictures, far enough apart to share no drop
constexpr int block = 8;      // pixels: statistics are pooled over blocks, or six pictures would be too few

struct Setting {
  std::string name;
  float distance_m;  // 0: fog alone
  std::int32_t most_drops;
};

struct Row {
  Setting setting;
  double drops = 0.0, ms_min = 0.0, ms_median = 0.0;
  double mean_error = 0.0, deviation_error = 0.0, error = 0.0, mean_shift = 0.0;
  bool sound = true, on_hull = false;
};

using Image = std::vector<float>;  // luminance, output units

struct Statistics {
  Image mean, deviation;  // over time, by block
};

class Studio {
 public:
  static Result<Studio> make(bool software) {
    Studio studio;
    studio.width_ = software ? 240 : 640;
    studio.height_ = software ? 136 : 360;
    StageSet set;
    set.present = false;
    set.wall_cd_m2 = glm::vec3(0.6f);
    set.wall_distance_m = wall_m;
    set.wall_hides = true;
    auto stage = RainStage::make(software, set);
    if (!stage) return tl::unexpected(stage.error());
    studio.stage_ = std::move(*stage);
    return studio;
  }

  Frame frame(double time_s) const {
    Frame f = stage_frame(width_, height_, glm::dvec3(0.0, 1.7, 0.0));
    f.camera.vertical_fov_rad = glm::radians(30.0f);
    f.camera.exposure_ev100 = 0.0f;
    f.time_s = time_s;
    for (const glm::vec3 at :
         {glm::vec3(-2.5f, 3.0f, -9.0f), glm::vec3(2.0f, 4.0f, -14.0f), glm::vec3(0.5f, 2.0f, -17.0f)}) {
      FrameLight light{};
      light.position_m = at;
      light.direction = {0.0f, -1.0f, 0.0f};
      light.intensity = {150.0f, 120.0f, 90.0f};
      light.source_radius_m = 0.08f;
      light.kind = LIGHT_POINT;
      light.lights_rain = true;
      f.lights.push_back(light);
    }
    return f;
  }

  Result<Image> draw(Frame& f) {
    f.number = ++number_;
    if (auto drawn = stage_->draw(f); !drawn) return tl::unexpected(drawn.error());
    const std::vector<float> light = stage_->read_light();
    Image image(light.size() / 4);
    for (std::size_t i = 0; i < image.size(); ++i) {
      image[i] = (0.2126f * light[4 * i] + 0.7152f * light[4 * i + 1] + 0.0722f * light[4 * i + 2]) * f.uniforms.lens.w;
    }
    return image;
  }

  // Every drop that can be seen before the wall, at 64 instants of the exposure.
  Result<Image> truth(const Emitter& emitter, const WindMotion& wind, double time_s) {
    Image sum;
    for (int i = 0; i < instants; ++i) {
      Frame f = frame(time_s);
      const double earlier = f.camera.exposure_s * (i + 0.5) / instants;
      f.camera.exposure_s = 0.0f;
      f.rain = make_frame_rain(emitter, wind, f.camera, width_, height_, time_s - earlier);
      f.rain->fade_start_m = 1.2f * wall_m;  // beyond the wall's corners: nothing is left to fog
      f.rain->drawn_distance_m = 1.21f * wall_m;
      auto image = draw(f);
      if (!image) return image;
      if (sum.empty()) sum.assign(image->size(), 0.0f);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += (*image)[k] / instants;
    }
    return sum;
  }

  void finish() const { glFinish(); }
  int width() const { return width_; }
  int height() const { return height_; }
  RainStage& stage() { return *stage_; }

  Statistics statistics(const std::vector<Image>& images) const {
    Statistics s;
    const int across = width_ / block, up = height_ / block;
    s.mean.assign(std::size_t(across) * up, 0.0f);
    s.deviation = s.mean;
    const double count = static_cast<double>(images.size());
    for (int y = 0; y < up * block; ++y) {
      for (int x = 0; x < across * block; ++x) {
        double sum = 0.0, squares = 0.0;
        for (const Image& image : images) {
          const double v = image[std::size_t(y) * width_ + x];
          sum += v;
          squares += v * v;
        }
        const double variance = std::max(0.0, (squares - sum * sum / count) / (count - 1.0));
        const std::size_t at = std::size_t(y / block) * across + x / block;
        s.mean[at] += static_cast<float>(sum / count / (block * block));
        s.deviation[at] += static_cast<float>(variance / (block * block));
      }
    }
    for (float& v : s.deviation) v = std::sqrt(v);
    return s;
  }

 private:
  std::unique_ptr<RainStage> stage_;
  int width_ = 0, height_ = 0;
  std::uint64_t number_ = 0;
};

double rms(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += double(a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

double average(const Image& a) {
  double sum = 0.0;
  for (const float v : a) sum += v;
  return sum / static_cast<double>(a.size());
}

}  // namespace

Result<void> chart_rainfall(const ChartRun& run) {
  const bool software = run.software;
  const auto& progress = run.progress;
  auto studio = Studio::make(software);
  if (!studio) return tl::unexpected(studio.error());

  Emitter emitter;
  emitter.rain_mm_per_hour = 10.0f;
  emitter.maximum_drops = 400000000;
  Wind wind;
  wind.velocity_mps = {1.5f, 0.0f, 0.0f};
  const WindMotion motion = start_rain_motion(emitter, wind);
  const std::vector<Setting> settings{{"fog", 0.0f, 0},
                                      {"to 2.5 m", 2.5f, 400000000},
                                      {"to 5 m", 5.0f, 400000000},
                                      {"to 10 m", 10.0f, 400000000},
                                      {"to 15 m", 15.0f, 400000000},
                                      {"to 25 m", 25.0f, 400000000},
                                      {"3 k drops", 25.0f, 3000},
                                      {"30 k drops", 25.0f, 30000},
                                      {"300 k drops", 25.0f, 300000}};
  constexpr int repeats = 12;
  const double total = 2.0 * moments * instants + static_cast<double>(settings.size()) * (moments + repeats);
  double done = 0.0;
  const auto advance = [&](double steps) {
    done += steps;
    if (progress) progress(std::min(1.0, done / total));
  };
  const auto moment = [](int i) { return 20.0 + 0.83 * i; };

  std::array<Statistics, 2> truths;
  for (int which = 0; which < 2; ++which) {
    Emitter other = emitter;
    other.seed = emitter.seed + which;
    std::vector<Image> images;
    for (int i = 0; i < moments; ++i) {
      auto image = studio->truth(other, motion, moment(i));
      if (!image) return tl::unexpected(image.error());
      images.push_back(std::move(*image));
      advance(instants);
    }
    truths[which] = studio->statistics(images);
  }
  const Statistics& truth = truths[0];
  // Without rain the mean is the wall's and nothing deviates.
  Frame dry_frame = studio->frame(0.0);
  auto dry_image = studio->draw(dry_frame);
  if (!dry_image) return tl::unexpected(dry_image.error());
  const Statistics dry = studio->statistics(std::vector<Image>(2, *dry_image));
  const auto error = [](const Statistics& a, const Statistics& b) {
    return rms(a.mean, b.mean) + rms(a.deviation, b.deviation);
  };
  const double off = error(dry, truth), floor = error(truths[1], truth) / off;

  std::vector<Row> rows;
  for (const Setting& setting : settings) {
    Row row;
    row.setting = setting;
    Emitter limited = emitter;
    limited.drawn_distance_m = setting.distance_m;
    limited.maximum_drops = setting.most_drops;
    std::vector<Image> images;
    for (int i = 0; i < moments; ++i) {
      Frame f = studio->frame(moment(i));
      f.rain = make_frame_rain(limited, motion, f.camera, f.width, f.height, f.time_s);
      auto image = studio->draw(f);
      if (!image) return tl::unexpected(image.error());
      row.drops += rain_stats(f).drops_drawn / double(moments);
      images.push_back(std::move(*image));
      advance(1.0);
    }
    std::vector<double> times;
    for (int i = 0; i < repeats; ++i) {
      Frame f = studio->frame(moment(0) + i / 60.0);
      studio->finish();
      const auto start = std::chrono::steady_clock::now();
      f.number = 1000000 + std::uint64_t(i);
      f.rain = make_frame_rain(limited, motion, f.camera, f.width, f.height, f.time_s);
      if (auto drawn = studio->stage().draw(f); !drawn) return drawn;
      studio->finish();
      times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
      advance(1.0);
    }
    const Statistics found = studio->statistics(images);
    row.ms_min = *std::min_element(times.begin(), times.end());
    row.ms_median = quantile(times, 0.5);
    row.mean_error = rms(found.mean, truth.mean) / off;
    row.deviation_error = rms(found.deviation, truth.deviation) / off;
    row.error = error(found, truth) / off;
    row.mean_shift = (average(found.mean) - average(truth.mean)) / average(dry.mean);
    row.sound = std::isfinite(row.error) && std::abs(row.mean_shift) < 0.005;
    rows.push_back(row);
  }
  Chart chart;
  chart.name = chart.effect = "rainfall";
  chart.title = "Falling rain, 10 mm/h";
  chart.device = run.device;
  chart.width = studio->width();
  chart.height = studio->height();
  chart.floor = floor;
  for (const Row& r : rows)
    chart.points.push_back({r.setting.distance_m > 0.0f ? "drop_field" : "fog", r.setting.name, r.ms_median, r.ms_min,
                            r.ms_median, r.error, r.mean_shift, r.sound, {{"drops", r.drops}}});
  return write_chart(run.folder, chart);
}

}  // namespace petrichor
