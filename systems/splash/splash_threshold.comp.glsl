#version 450 core
// From how many splashes live, by importance, to the importance below which they are thinned out: kept with odds in
// proportion to it, so that each kept one, made brighter by the inverse, adds the same.
layout(local_size_x = 1) in;
#include "systems/splash/splash_shared.h"
layout(std430, binding = SPLASH_COMMAND_BINDING) buffer SplashCommand { SplashCommandGpu command; };
uniform float most;

void main() {
  float all = 0.0, weighed = 0.0;  // of the bins that are left
  for (int b = 0; b < SPLASH_BINS; ++b) {
    float n = float(command.expected[b >> 2][b & 3]) / 256.0;
    all += n;
    weighed += n * exp2(0.5 * (float(b) + 0.5) + float(SPLASH_LEAST_LOG));
  }
  command.threshold = vec4(0.0, all, 0.0, 0.0);
  if (all <= most) return;
  // From the most important down: as long as the odds of the next bin would be above 1 it is kept whole.
  float kept = 0.0;
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
  command.threshold.x = max(weighed, 1e-30) / max(most - kept, 1.0);
}
