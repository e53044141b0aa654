#include "systems/ripple/rings.hpp"

#include <algorithm>
#include <cmath>

#include "systems/ripple/ripple_shared.h"
#include "systems/ripple/truth.hpp"

namespace petrichor {
namespace {

// No wave of a ring has run farther: the quickest that carry something, of 5 mm, go 0.47 m/s as a group.
double ring_reach_m(double age_s) {
  return std::min(seed_reach * natural_seed_m + 0.4 * age_s, ring_radius_step_m * (RIPPLE_TABLE_RADII - 2));
}

}  // namespace

void RippleRings::draw(const Program& program, const Texture& map, int level, int layer,
                       const std::vector<RippleRing>& rings, const RingLayer& on, float share) {
  if (decay_ != on.decay_per_s) {
    RingTable table =
        make_ring_table(RIPPLE_TABLE_RADII, RIPPLE_TABLE_TIMES, ring_radius_step_m, ring_time_step_s, on.decay_per_s);
    // Towards their end they fade: after some time, and at the table's last radius.
    for (int t = 0; t < table.times; ++t)
      for (int r = 0; r < table.radii; ++r) {
        const double late = std::clamp((ring_life_s - t * ring_time_step_s) / 0.4, 0.0, 1.0);
        const double far = std::clamp((table.radii - 2.0 - r) / 40.0, 0.0, 1.0);
        table.slope[static_cast<std::size_t>(t) * table.radii + r] *= static_cast<float>(late * far);
      }
    table_ = make_buffer(table.slope.size() * sizeof(float), table.slope.data());
    decay_ = on.decay_per_s;
  }
  std::vector<glm::vec4> packed;
  for (const RippleRing& r : rings) packed.emplace_back(glm::vec2(r.place_m), r.age_s, r.amplitude_m);
  // A list of rings for each block; by their order, so that sums are always the same.
  const int cells = map.width >> level, side = (cells + RIPPLE_BLOCK - 1) / RIPPLE_BLOCK;
  const double block_m = RIPPLE_BLOCK * on.cell_m, half_m = 0.7072 * block_m;
  std::vector<std::uint32_t> lists(static_cast<std::size_t>(2 * side * side));
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const auto block = static_cast<std::size_t>(2 * (y * side + x));
      lists[block] = static_cast<std::uint32_t>(lists.size());
      const glm::dvec2 middle = (glm::dvec2(x, y) + 0.5) * block_m;
      for (std::size_t i = 0; i < rings.size(); ++i) {
        glm::dvec2 away = middle - rings[i].place_m;
        if (on.edge_m > 0.0) away -= on.edge_m * glm::round(away / on.edge_m);
        if (glm::length(away) < ring_reach_m(rings[i].age_s) + half_m) lists.push_back(static_cast<std::uint32_t>(i));
      }
      lists[block + 1] = static_cast<std::uint32_t>(lists.size()) - lists[block];
    }
  if (!packed.empty())
    upload(rings_, std::span<const glm::vec4>(packed));
  else if (rings_.bytes == 0)
    rings_ = make_buffer(sizeof(glm::vec4));
  upload(lists_, std::span<const std::uint32_t>(lists));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RIPPLE_SEEDS_BINDING, rings_.id);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RIPPLE_STAMPS_BINDING, lists_.id);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RIPPLE_TABLE_BINDING, table_.id);
  glBindImageTexture(0, map.id, level, GL_FALSE, layer, GL_WRITE_ONLY, GL_RGBA16F);
  program.use();
  program.set("cells", cells);
  program.set("cell_m", static_cast<float>(on.cell_m));
  program.set("edge_m", static_cast<float>(on.edge_m));
  program.set("table_step", glm::vec2(ring_radius_step_m, ring_time_step_s));
  program.set("share", share);
  program.dispatch(cells, cells);
}

}  // namespace petrichor
