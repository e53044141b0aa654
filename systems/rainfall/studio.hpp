#pragma once
// Where ways to draw falling rain are compared: a wall, lamps or daylight, a camera that may move, and the engine's own
// systems, so that a technique is charted as it is played. Needs a current OpenGL context.

#include <memory>
#include <string>
#include <vector>

#include "components/components.hpp"
#include "engine/core/result.hpp"
#include "engine/ecs/schedule.hpp"
#include "systems/chart.hpp"
#include "systems/rainfall/stage.hpp"
#include "systems/system_context.hpp"

namespace petrichor {

struct StudioScene {
  std::string name;   // "night"
  std::string title;  // "night lamps, 10 mm/h"
  float rain_mm_per_hour = 10.0f;
  float snow_mm_per_hour = 0.0f;
  Wind wind;
  glm::vec3 camera_velocity_mps{0.0f};
  glm::vec3 wall_cd_m2{0.6f};
  float wall_distance_m = 20.0f;
  float sky_cd_m2 = 0.02f;  // the same all round
  float exposure_ev100 = 0.0f;
  std::vector<glm::vec3> lamps_m;  // relative to where the camera starts
  glm::vec3 lamp_cd{150.0f, 120.0f, 90.0f};
};
StudioScene day_street();
StudioScene night_lamps();
StudioScene storm();

using Picture = std::vector<float>;  // luminance, output units (1 is white), row 0 at the bottom

// What can fairly be said of random rain (physics, section 14): over some moments, by block of pixels, the mean and the
// deviation; and of what deviates, how its power is spread over sizes and directions (a log-polar power spectrum that
// sums to 1; empty where nothing deviates).
struct Statistics {
  Picture mean, deviation;
  std::vector<double> spectrum;
};
Statistics statistics_of(const std::vector<Picture>&, int width, int height);

// 0: the same; 1: no rain at all. Half of it is mean and deviation, root mean square over the blocks, and half is the
// distance of the spectra (half the sum of the differences).
struct StatisticsError {
  double mean = 0.0, deviation = 0.0, spectrum = 0.0, all = 0.0;
  double mean_shift = 0.0;  // of the whole picture's mean, as a share of the dry one's
};
StatisticsError compare(const Statistics& found, const Statistics& truth, const Statistics& dry);

class Studio {
 public:
  // Size 0: 240x136 on software OpenGL, else 640x360.
  static Result<std::unique_ptr<Studio>> make(bool software, const StudioScene&, int width = 0, int height = 0);

  // What a rung is drawn with. A change begins the scene anew, at time 0.
  struct Cast {
    Techniques techniques;
    Emitter emitter;  // its rate is the scene's
    DoubleCone cone;
    LayeredComposite layered;
    StreakSprites sprites;
    Snowfall snowfall;  // its rate is the scene's
  };
  void begin(const Cast&);
  Cast cast() const;  // of the scene's rate, all as by default

  // The frame at a time no earlier than the one asked for last.
  Frame frame(double time_s);
  Result<Picture> draw(Frame&);
  // Milliseconds of the rain's own passes, by glFinish on software OpenGL and by GPU timers elsewhere.
  Result<std::vector<Timing>> time_passes(Frame&);
  Result<double> time(Frame&);  // their sum
  // Every drop before the wall, the mean of so many instants of the exposure.
  int truth_instants() const { return software_ ? 32 : 64; }
  Result<Picture> truth(double time_s, std::uint32_t seed);
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  Studio() = default;
  StudioScene scene_;
  std::unique_ptr<RainStage> stage_;
  Registry registry_;
  Commands commands_{registry_};
  std::unique_ptr<Schedule<SystemContext>> schedule_;
  std::vector<std::shared_ptr<const Model>> no_models_;
  Entity weather_, camera_;
  std::int64_t tick_ = -1;
  double last_s_ = -1.0;
  Techniques techniques_;
  int width_ = 0, height_ = 0;
  bool software_ = true;
  std::uint64_t number_ = 0;
};

}  // namespace petrichor
