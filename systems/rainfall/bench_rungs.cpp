#include "systems/rainfall/bench_rungs.hpp"

#include <chrono>
#include <map>
#include <string>

#include "systems/rainfall/ladders.hpp"
#include "systems/rainfall/studio.hpp"

namespace petrichor {

using Clock = std::chrono::steady_clock;

Result<std::vector<BenchRow>> bench_rungs(int width, int height, int frames, bool software_gl, int affordable_drops) {
  constexpr int warm_up = 4;
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  std::vector<BenchRow> rows;
  const Ladder ladder = rainfall_ladder();
  for (const float rate : {1.0f, 10.0f, 100.0f}) {
    StudioScene scene = night_lamps();
    scene.rain_mm_per_hour = rate;
    auto made = Studio::make(software_gl, scene, width, height);
    if (!made) return tl::unexpected(made.error());
    Studio& studio = **made;
    for (std::size_t rung = 0; rung < ladder.rungs.size(); ++rung) {
      Studio::Cast cast = studio.cast();
      cast.techniques.set(Effect::rainfall, static_cast<RainRung>(rung));
      if (static_cast<RainRung>(rung) != RainRung::full_field) cast.emitter.maximum_drops = affordable_drops;
      studio.begin(cast);
      std::vector<double> whole;
      std::map<std::string, std::vector<double>> passes;
      // A GPU that has waited runs at a lower clock: it is kept busy for a while before frames are timed.
      if (!software_gl) {
        Frame frame = studio.frame(0.0);
        for (const auto start = Clock::now(); Clock::now() - start < std::chrono::milliseconds(400); glFinish())
          if (auto drawn = studio.draw(frame); !drawn) return tl::unexpected(drawn.error());
      }
      for (int i = 0; i < warm_up + frames; ++i) {
        Frame frame = studio.frame(i / 60.0);
        auto timings = studio.time_passes(frame);
        if (!timings) return tl::unexpected(timings.error());
        if (i < warm_up) continue;
        double sum = 0.0;
        for (const Timing& t : *timings) {
          sum += t.milliseconds;
          passes[t.name].push_back(t.milliseconds);
        }
        whole.push_back(sum);
      }
      const auto row = [&](const std::string& name, const std::vector<double>& samples) {
        const double median = quantile(samples, 0.5);
        rows.push_back({"rungs/" + name, std::to_string(static_cast<int>(rate)), size, median, quantile(samples, 0.95),
                        software_gl ? std::nullopt : std::optional<double>(median)});
      };
      const std::string name(ladder.rungs[rung].name);
      row(name, whole);
      for (const auto& [pass, samples] : passes) row(name + "/" + pass, samples);
    }
  }
  return rows;
}

}  // namespace petrichor
