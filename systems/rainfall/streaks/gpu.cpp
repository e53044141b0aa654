#include "systems/rainfall/streaks/gpu.hpp"

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
  const int entries = table.grid.entries();
  gpu.modulations = make_texture_2d_array(table.along, table.oscillations, entries, GL_R32F);
  glTextureSubImage3D(gpu.modulations.id, 0, 0, 0, 0, table.along, table.oscillations, entries, GL_RED, GL_FLOAT,
                      table.modulation.data());
  glTextureParameteri(gpu.modulations.id, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTextureParameteri(gpu.modulations.id, GL_TEXTURE_WRAP_T, GL_REPEAT);
  std::vector<float> profiles;
  profiles.reserve(std::size_t(table.across + 1) * entries);
  for (int entry = 0; entry < entries; ++entry) {
    const auto first = table.profile.begin() + std::ptrdiff_t(entry) * table.across;
    profiles.insert(profiles.end(), first, first + table.across);
    profiles.push_back(std::log(table.mean[entry]));
  }
  gpu.profiles = make_texture_2d_array(table.across + 1, 1, entries, GL_R32F);
  glTextureSubImage3D(gpu.profiles.id, 0, 0, 0, 0, table.across + 1, 1, entries, GL_RED, GL_FLOAT, profiles.data());
  gpu.phase = make_texture_2d(static_cast<int>(table.phase.size()), 1, GL_R32F);
  glTextureSubImage2D(gpu.phase.id, 0, 0, 0, gpu.phase.width, 1, GL_RED, GL_FLOAT, table.phase.data());
  return gpu;
}

Result<std::shared_ptr<const StreakTable>> shared_streak_table() {
  if (shared()) return shared();
  const auto file = find_data("content/streaks.exr");
  if (!file)
    return failure(file.error().message +
                   "; the build bakes it, and so does `petrichor bake streaks`; without it draw with --technique "
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
