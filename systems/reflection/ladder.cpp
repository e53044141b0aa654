#include <algorithm>

#include "systems/reflection/reflection.hpp"

namespace petrichor {

Ladder reflections_ladder() {
  Ladder l;
  l.effect = Effect::reflections;
  l.name = "reflections";
  l.meaning = "what wet ground and glossy surfaces mirror";
  l.truth = "GGX integrated by rays (Embree) over lamps, lit panels, walls, posts and sky";
  l.error_measure =
      "root of the mean squared error of what black ground mirrors, relative to it (relMSE); nothing mirrored: 1";
  // Of the chart on wet asphalt, llvmpipe at 640x360 on a busy machine (two to three times as slow as a quiet one).
  l.rungs = {
      {"environment", "the captured surroundings and lamps' highlights alone", {}, 0.0, 0.81, true},
      // tests/stability/reflections.cpp: ThePublishedStretchIgnoresElevation, ThePublishedEdgesRemoveGrazingLight.
      {"toyshop",
       "billboards stretched by distance and streaked (as printed)",
       {"reflections", "reflections_over"},
       22.0,
       1.54,
       false},
      {"impostors",
       "lamps, lit panels and posts, each with the closed form of its streak",
       {"reflections", "reflections_over"},
       30.0,
       0.29,
       true},
      {"screen_space",
       "rays through the picture, with stand-ins where they leave it",
       {"reflections", "reflections_over"},
       46.0,
       0.34,
       true},
      {"planar",
       "screen_space, with planar mirrors on still water and panes",
       {"mirrors", "reflections", "reflections_over"},
       150.0,
       0.82,
       true}};
  // Wet ground fills about a third of a street's picture; dry, only glossy things mirror. Nothing: the passes do not
  // run.
  l.coverage = [](const Frame& frame) {
    if (frame.instances.empty()) return 0.0;
    const bool wet = frame.wetness || frame.puddles || (frame.rain && frame.rain->rain_mm_per_hour > 0.0f);
    if (wet) return 0.35;
    // Unknown while no rung has asked for reflectors: little, so that the director may ask.
    const bool asked = frame.techniques.share(Effect::reflections, ReflectionRung::environment) < 1.0f;
    return asked && !frame.reflectors ? 0.0 : 0.05;
  };
  return l;
}

}  // namespace petrichor
