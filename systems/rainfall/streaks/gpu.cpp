#include "systems/rainfall/streaks/gpu.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/core/paths.hpp"

namespace petrichor {
namespace {

std::shared_ptr<const StreakTable>& shared() {
  static std::shared_ptr<const StreakTable> table;
  return table;
}

}  // namespace

StreakTableGpu upload_streak_table(const StreakTable& table) {
  StreakTableGpu gpu;
  gpu.grid = table.grid;
  gpu.along = table.along;
  gpu.oscillations = table.oscillations;
  // An array of layers an entry would pass the 2048 layers that drivers must offer.
  const StreakGrid& g = table.grid;
  const int tile_x = table.along + 1, tile_y = table.oscillations + 1, tile_across = table.across + 1;
  gpu.modulations = make_texture_2d_array(g.azimuth * tile_x, g.light * tile_y, g.view, GL_R32F);
  gpu.profiles = make_texture_2d_array(g.azimuth * tile_across, g.light, g.view, GL_R32F);
  std::vector<float> tile(std::size_t(tile_x) * tile_y), profile(tile_across);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (int view = 0, entry = 0; view < g.view; ++view)
    for (int light = 0; light < g.light; ++light)
      for (int azimuth = 0; azimuth < g.azimuth; ++azimuth, ++entry) {
        const float* states = &table.modulation[std::size_t(entry) * table.along * table.oscillations];
        for (int y = 0; y < tile_y; ++y)
          for (int x = 0; x < tile_x; ++x)
            tile[std::size_t(y) * tile_x + x] = states[y % table.oscillations * table.along + x % table.along];
        glTextureSubImage3D(gpu.modulations.id, 0, azimuth * tile_x, light * tile_y, view, tile_x, tile_y, 1, GL_RED,
                            GL_FLOAT, tile.data());
        std::copy_n(&table.profile[std::size_t(entry) * table.across], table.across, profile.begin());
        profile.back() = std::log(table.mean[entry]);
        glTextureSubImage3D(gpu.profiles.id, 0, azimuth * tile_across, light, view, tile_across, 1, 1, GL_RED, GL_FLOAT,
                            profile.data());
      }
  gpu.phase = make_texture_2d(static_cast<int>(table.phase.size()), 1, GL_R32F);
  glTextureSubImage2D(gpu.phase.id, 0, 0, 0, gpu.phase.width, 1, GL_RED, GL_FLOAT, table.phase.data());
  return gpu;
}

Result<std::shared_ptr<const StreakTable>> shared_streak_table() {
  if (shared()) return shared();
  const auto file = find_data("content/streaks.exr");
  if (!file)
    return failure(file.error().message +
                   " The build bakes it, and so does `petrichor bake streaks`; without it draw with --technique "
                   "streaks=even");
  auto table = load_streak_table(file->string());
  if (!table) return tl::unexpected(table.error());
  return shared() = std::make_shared<const StreakTable>(std::move(*table));
}

void use_streak_table(std::shared_ptr<const StreakTable> table) {
  shared() = std::move(table);
}

bool bind_streak_table(RainOptics& optics, const Frame& frame, const Program& program) {
  const float nearest = frame.techniques.share(Effect::streaks, StreakRung::nearest);
  const float all = frame.techniques.share(Effect::streaks, StreakRung::table);
  const bool read = shared() && nearest + all > 0.0f;
  program.set("streak_strength", read ? nearest + all : 0.0f);
  if (!read) return false;
  if (optics.streaks_of != shared()) {
    optics.streaks = std::make_shared<const StreakTableGpu>(upload_streak_table(*shared()));
    optics.streaks_of = shared();
  }
  const StreakTableGpu& table = *optics.streaks;
  glBindTextureUnit(13, table.modulations.id);
  glBindTextureUnit(12, table.profiles.id);
  glBindTextureUnit(11, table.phase.id);
  program.set("streak_table_nodes",
              glm::vec4(table.grid.view, table.grid.light, table.grid.azimuth, nearest > all ? 1.0f : 2.0f));
  program.set("streak_table_size", glm::vec2(table.along, table.oscillations));
  return true;
}

}  // namespace petrichor
