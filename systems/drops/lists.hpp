#pragma once
// Single drops into the sums, host side: the shaders that whoever draws drops needs, and the lists of long streaks
// (streak_lists.glsl) that rain_lines draws after them.

#include <string>
#include <string_view>

#include "engine/graph/graph.hpp"
#include "systems/drops/rain_shared.h"
#include "systems/drops/sums.hpp"

namespace petrichor {

// RainCommand of the shaders. cell_count: whatever it is that the indirect dispatch goes through.
struct RainCommand {
  std::uint32_t groups_x = RAIN_COMMAND_WIDTH, groups_y = 0, groups_z = 1, cell_count = 0, drops_drawn = 0;
  std::uint32_t list_count[RAIN_LISTS] = {};
  std::uint32_t list_groups[6] = {RAIN_COMMAND_WIDTH, 0, 1, RAIN_COMMAND_WIDTH, 0, 1};
};

// "splat_scene_lamps": scene where there is a depth buffer, lamps where drops are lit by some.
std::string drop_shader(std::string_view name, bool scene, bool lamps);
// Of all four: `name` from `file`, `software_name` from `software_file` (with SOFTWARE), and those of the lists.
void add_drop_shaders(PassOffer&, std::string_view name, std::string_view file, std::string_view software_name,
                      std::string_view software_file);

// Room for the lists, bound for streak_lists.glsl. The streaks of one frame's lists share it with the next's.
void bind_streak_lists(RainSums&, bool software);
// Draws what `command` (bound) lists; between the dispatch that listed and this a memory barrier.
void draw_long_streaks(const Buffer& command, PassContext&, bool scene, bool lamps);  // GPUs
// Software OpenGL: reads the counts, draws, and empties the lists.
void draw_sorted_streaks(Buffer& command, PassContext&, bool scene, bool lamps);

}  // namespace petrichor
