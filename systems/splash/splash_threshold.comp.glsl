#version 450 core
// From how many splashes live, by importance, to the importance below which they are thinned out: kept with odds in
// proportion to it, so that each kept one, made brighter by the inverse, adds the same.
layout(local_size_x = 64) in;
#include "systems/splash/splash_shared.h"
layout(std430, binding = SPLASH_COMMAND_BINDING) buffer SplashCommand { SplashCommandGpu command; };
uniform float most;
uniform bool of_listed;  // else of what the columns say, who count cells that are half out of view, and drops that spread

shared vec2 bins[SPLASH_BINS];  // how many, and what each weighs

void main() {
  int b = int(gl_LocalInvocationIndex);
  if (b < SPLASH_BINS)
    bins[b] = vec2(float(command.expected[b >> 2][b & 3]) / 256.0, exp2(0.5 * (float(b) + 0.5) + float(SPLASH_LEAST_LOG)));
  barrier();
  if (!of_listed && b < SPLASH_BINS / 4) command.expected[b] = uvec4(0u);
  if (b != 0) return;
  float all = 0.0, weighed = 0.0;  // of the bins that are left
  for (int i = 0; i < SPLASH_BINS; ++i) {
    all += bins[i].x;
    weighed += bins[i].x * bins[i].y;
  }
  float threshold = 0.0, kept = 0.0;
  if (all > most) {
    // From the most important down: as long as the odds of the next bin would be above 1 it is kept whole.
    for (int i = SPLASH_BINS - 1; i >= 0; --i) {
      float n = bins[i].x, middle = bins[i].y;
      if (most - kept <= 0.0 || middle * (most - kept) < weighed) break;
      kept += n;
      weighed -= n * middle;
    }
    threshold = max(weighed, 1e-30) / max(most - kept, 1.0);
  }
  if (of_listed) {
    command.threshold.y = threshold;
    command.threshold.z = min(all, most);
  } else {
    command.threshold = vec4(threshold, 0.0, 0.0, all);
  }
}
