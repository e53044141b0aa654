#pragma once
// The streak table on the GPU, for streak_table.glsl.

#include <memory>

#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "systems/frame.hpp"
#include "systems/drops/optics.hpp"
#include "systems/rainfall/streaks/table.hpp"

namespace petrichor {

struct StreakTableGpu {
  Texture modulations, profiles, phase;
  StreakGrid grid;
  int along = 0, oscillations = 0;
};

// Needs an OpenGL context.
StreakTableGpu upload_streak_table(const StreakTable&);

// The table that everything draws with: content/streaks.exr, read when first asked for. Errors name the file.
Result<std::shared_ptr<const StreakTable>> shared_streak_table();
void use_streak_table(std::shared_ptr<const StreakTable>);  // another one, or none; for tests

// Binds the table, if one was asked for, and sets the uniforms of streak_table.glsl for the rung of the frame
// (Effect::streaks). Without a table, or where streaks are even, the shader's functions return 1. Returns whether they
// may return anything else. The copy on the GPU is kept in the optics that all techniques share.
bool bind_streak_table(RainOptics&, const Frame&, const Program&);

}  // namespace petrichor
