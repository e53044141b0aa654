#include "systems/drops/lists.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace petrichor {

std::string drop_shader(std::string_view name, bool scene, bool lamps) {
  return std::string(name) + (scene ? "_scene" : "") + (lamps ? "_lamps" : "");
}

void add_drop_shaders(PassOffer& offer, std::string_view name, std::string_view file, std::string_view software_name,
                      std::string_view software_file) {
  for (const bool scene : {false, true}) {
    for (const bool lamps : {false, true}) {
      std::vector<std::string> defines;
      if (scene) defines.push_back("SCENE");
      if (lamps) defines.push_back("LAMPS");
      const auto add = [&](std::string_view shader, std::string_view source) {
        offer.shaders[drop_shader(shader, scene, lamps)] = {{std::string(source)}, defines};
      };
      add(name, file);
      add("long_lines", "systems/rainfall/rain_lines.comp.glsl");
      defines.push_back("CAPSULES");
      add("long_capsules", "systems/rainfall/rain_lines.comp.glsl");
      defines.back() = "SOFTWARE";
      add(software_name, software_file);
      add("lines", "systems/rainfall/rain_lines.comp.glsl");
      defines.push_back("CAPSULES");
      add("capsules", "systems/rainfall/rain_lines.comp.glsl");
    }
  }
}

void bind_streak_lists(RainSums& sums, bool software) {
  const std::size_t count = software ? std::size_t(RAIN_STREAK_CAPACITY) * RAIN_LISTS : RAIN_LONG_CAPACITY * 2;
  if (sums.streaks.bytes < count * sizeof(RainStreakGpu)) sums.streaks = make_buffer(count * sizeof(RainStreakGpu));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RAIN_STREAKS_BINDING, sums.streaks.id);
}

void draw_long_streaks(const Buffer& command, PassContext& context, bool scene, bool lamps) {
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, command.id);
  const GLintptr groups = offsetof(RainCommand, list_groups);
  context.program(drop_shader("long_lines", scene, lamps)).use();
  glDispatchComputeIndirect(groups);
  context.program(drop_shader("long_capsules", scene, lamps)).use();
  glDispatchComputeIndirect(groups + 12);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
}

// On a CPU reading counts back costs nothing, and exact sizes save empty dispatches.
void draw_sorted_streaks(Buffer& command, PassContext& context, bool scene, bool lamps) {
  RainCommand listed;
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  read_buffer(command, &listed, sizeof listed);
  for (unsigned list = 0; list < RAIN_LISTS; ++list) {
    if (listed.list_count[list] == 0) continue;
    const bool capsules = list == RAIN_LISTS - 1;
    const Program& lines = context.program(drop_shader(capsules ? "capsules" : "lines", scene, lamps));
    lines.use();
    lines.set("list", list);
    lines.set("list_size", unsigned(std::min<std::uint32_t>(listed.list_count[list], RAIN_STREAK_CAPACITY)));
    lines.set("taps", list < RAIN_LENGTHS ? 1 : 2);
    lines.dispatch(static_cast<int>(listed.list_count[list]));
  }
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  RainCommand next;
  next.cell_count = listed.cell_count;
  next.drops_drawn = listed.drops_drawn;
  upload(command, &next, sizeof next);
}

}  // namespace petrichor
