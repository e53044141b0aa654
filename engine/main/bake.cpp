// bake: tables computed from first principles.

#include "systems/rainfall/streaks/bake.hpp"

#include <fmt/format.h>

#include <chrono>

#include "engine/app/progress.hpp"
#include "engine/core/log.hpp"
#include "engine/core/paths.hpp"
#include "engine/main/commands.hpp"
#include "systems/rainfall/streaks/sheet.hpp"

namespace petrichor {

Result<void> bake(const BakeOptions& options) {
  StreakBake settings = options.fine ? fine_streak_bake() : StreakBake{};
  const auto take = [](int given, int& value) { value = given > 0 ? given : value; };
  take(options.views, settings.grid.view);
  take(options.lights, settings.grid.light);
  take(options.azimuths, settings.grid.azimuth);
  take(options.along, settings.along);
  take(options.oscillations, settings.oscillations);
  take(options.across, settings.across);
  take(options.rays, settings.rays);
  settings.threads = options.threads;
  settings.drop.diameter_mm = options.diameter_mm;
  settings.drop.prolate = options.prolate;
  settings.drop.sideways = options.sideways;
  settings.drop.exposure_s = options.exposure_s;
  const std::filesystem::path file =
      options.out.empty() ? executable_folder() / "content" / "streaks.exr" : options.out;
  if (file.extension() != ".exr")
    return wrong_call(
        fmt::format("--out {}: a streak table is an OpenEXR file; give a name that ends in .exr", file.string()));
  if (!options.picture.empty() && options.picture.extension() != ".png")
    return wrong_call(fmt::format("--picture {}: give a name that ends in .png", options.picture.string()));
  const auto start = std::chrono::steady_clock::now();
  StreakTable table;
  {
    Progress progress("tracing drops", 1000);
    table =
        bake_streaks(settings, [&](double share) { progress.advance_to(static_cast<std::int64_t>(share * 1000.0)); });
  }
  if (auto written = write_streak_table(file.string(), table); !written) return written;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  log_info("{}: {} entries of {} x {}, {:.1f} s", file.string(), table.grid.entries(), table.oscillations, table.along,
           seconds);
  if (!options.picture.empty()) return write_streak_sheet(options.picture.string(), table);
  return {};
}

}  // namespace petrichor
