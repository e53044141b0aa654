#include "systems/ripple/bench.hpp"

#include <chrono>
#include <string>

#include "systems/ripple/ripple.hpp"
#include "systems/ripple/stage.hpp"

namespace petrichor {

Result<std::vector<BenchRow>> bench_ripples(int frames, bool software_gl) {
  std::vector<BenchRow> rows;
  const Ladder ladder = ripples_ladder();
  for (std::size_t rung = 1; rung < ladder.rungs.size(); ++rung)
    for (const float rate : {10.0f, 50.0f}) {
      RippleStage stage;
      stage.software = software_gl;
      stage.emitter().rain_mm_per_hour = rate;
      stage.techniques.set(Effect::ripples, static_cast<RippleRung>(rung));
      if (auto loaded = stage.load(256); !loaded) return tl::unexpected(loaded.error());
      stage.run(5.99);
      const std::string name = "ripples/" + std::string(ladder.rungs[rung].name);
      const auto row = [&](const std::string& of, const std::string& n, const std::vector<double>& ms) {
        const double median = quantile(ms, 0.5);
        rows.push_back(
            {of, n, "256x256", median, quantile(ms, 0.95), software_gl ? std::nullopt : std::optional<double>(median)});
      };
      const auto first = stage.draw(stage.frame());
      if (!first) return tl::unexpected(first.error());
      row(name + "/alone", std::to_string(stage.ticks()), {*first});
      // A GPU that has waited runs at a lower clock.
      using Clock = std::chrono::steady_clock;
      if (!software_gl)
        for (const auto start = Clock::now(); Clock::now() - start < std::chrono::milliseconds(300);) {
          stage.tick();
          if (auto drawn = stage.draw(stage.frame()); !drawn) return tl::unexpected(drawn.error());
        }
      std::vector<double> ms;
      for (int i = 0; i < frames + 4; ++i) {
        stage.tick();
        stage.tick();
        const auto drawn = stage.draw(stage.frame());
        if (!drawn) return tl::unexpected(drawn.error());
        if (i >= 4) ms.push_back(*drawn);
      }
      row(name, std::to_string(static_cast<int>(rate)), ms);
    }
  return rows;
}

}  // namespace petrichor
