#version 450 core
// From how many splashes live, by importance, to the importance below which they are thinned out: kept with odds in
// proportion to it, so that each kept one, made brighter by the inverse, adds the same.
layout(local_size_x = 1) in;
#include "systems/splash/splash_shared.h"
layout(std430, binding = SPLASH_COMMAND_BINDING) buffer SplashCommand { SplashCommandGpu command; };
uniform float most;
uniform bool of_listed;  // else of what the columns say, who count cells that are half out of view, and drops that spread

void main() {
  float all = 0.0, weighed = 0.0;  // of the bins that are left
  for (int b = 0; b < SPLASH_BINS; ++b) {
    float n = float(command.expected[b >> 2][b & 3]) / 256.0;
    all += n;
    weighed += n * exp2(0.5 * (float(b) + 0.5) + float(SPLASH_LEAST_LOG));
  }
  float threshold = 0.0, kept = 0.0;
  if (all > most) {
    // From the most important down: as long as the odds of the next bin would be above 1 it is kept whole.
    for (int b = SPLASH_BINS - 1; b >= 0; --b) {
      float n = float(command.expected[b >> 2][b & 3]) / 256.0;
      float middle = exp2(0.5 * (float(b) + 0.5) + float(SPLASH_LEAST_LOG));
      if (most - kept > 0.0 && middle * (most - kept) >= weighed) {
        kept += n;
        weighed -= n * middle;
      } else {
        break;
      }
    }
    threshold = max(weighed, 1e-30) / max(most - kept, 1.0);
  }
  if (of_listed) {
    command.threshold.y = threshold;
    command.threshold.z = min(all, most);
    return;
  }
  command.threshold = vec4(threshold, 0.0, 0.0, all);
  for (int b = 0; b < SPLASH_BINS / 4; ++b) command.expected[b] = uvec4(0u);
}
