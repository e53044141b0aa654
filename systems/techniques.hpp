#pragma once
// By which technique each effect of a frame is drawn. A choice, not a component: it comes from the director or from
// the command line, and the same world may be drawn by any.

#include <algorithm>
#include <array>
#include <cstdint>

namespace petrichor {

// The effects that have a ladder (systems/ladder.hpp), and their rungs, cheapest first. The order is that of
// all_ladders(), which gives them names, meanings, errors and costs.
enum class Effect : std::uint8_t {
  rainfall, snow, streaks, near_drops, occlusion,
  splashes, splatter, halos, drips, ripples, puddles, wetness, reflections, probes,
  antialias, resolution, count
};

enum class RainRung : std::uint8_t { fog, double_cone, composite, sprites, drop_field, full_field, near_drops, count };
enum class SnowRung : std::uint8_t { fog, double_cone, field, count };
enum class StreakRung : std::uint8_t { even, nearest, table, count };          // light along a streak
enum class NearDropRung : std::uint8_t { off, maps, closed_form, count };      // of RainRung::near_drops
enum class OcclusionRung : std::uint8_t { vertical, tilted, jittered, count };  // maps of shelter
enum class SplashRung : std::uint8_t { none, random, field, secondary, count };
enum class SplatterRung : std::uint8_t { none, shells, count };
enum class HaloRung : std::uint8_t { none, layer, fins, count };
enum class DripRung : std::uint8_t { none, billboards, streaks, refracting, count };
enum class RippleRung : std::uint8_t { none, rings, euler, verlet5, verlet9, near_tile, count };
enum class PuddleRung : std::uint8_t { none, masks, filled, count };
enum class WetnessRung : std::uint8_t { none, everywhere, sheltered, flowing, count };
enum class ReflectionRung : std::uint8_t { environment, toyshop, impostors, screen_space, planar, count };
enum class ProbeRung : std::uint8_t { shared, moving, count };  // what moving objects mirror
enum class AntialiasRung : std::uint8_t { off, edges, count };
enum class ResolutionRung : std::uint8_t { half, two_thirds, full, count };

// While one rung gives way to another both are drawn, and share the effect between them.
struct Choice {
  std::uint8_t rung = 0;
  std::uint8_t from = 0;
  float blend = 1.0f;  // share of `rung`; `from` has the rest
};

constexpr std::size_t effect_count = static_cast<std::size_t>(Effect::count);

struct Techniques {
  std::array<Choice, effect_count> choices{};

  Techniques() {
    set(Effect::rainfall, RainRung::drop_field);
    set(Effect::snow, SnowRung::field);
    set(Effect::streaks, StreakRung::table);
    set(Effect::near_drops, NearDropRung::closed_form);
    set(Effect::occlusion, OcclusionRung::tilted);
    set(Effect::splashes, SplashRung::secondary);
    set(Effect::splatter, SplatterRung::shells);
    set(Effect::halos, HaloRung::fins);
    set(Effect::drips, DripRung::refracting);
    set(Effect::ripples, RippleRung::near_tile);
    set(Effect::puddles, PuddleRung::filled);
    set(Effect::wetness, WetnessRung::flowing);
    set(Effect::reflections, ReflectionRung::planar);
    set(Effect::probes, ProbeRung::moving);
    set(Effect::antialias, AntialiasRung::edges);
    set(Effect::resolution, ResolutionRung::full);
  }
  Choice& operator[](Effect effect) { return choices[static_cast<std::size_t>(effect)]; }
  const Choice& operator[](Effect effect) const { return choices[static_cast<std::size_t>(effect)]; }
  template <class Rung>
  void set(Effect effect, Rung rung) {
    (*this)[effect] = {static_cast<std::uint8_t>(rung), static_cast<std::uint8_t>(rung), 1.0f};
  }
  // 0 to 1; over all rungs of an effect they sum to 1.
  template <class Rung>
  float share(Effect effect, Rung rung) const {
    const Choice& c = (*this)[effect];
    const auto index = static_cast<std::uint8_t>(rung);
    const float blend = std::clamp(c.blend, 0.0f, 1.0f);
    return (c.rung == index ? blend : 0.0f) + (c.from == index ? 1.0f - blend : 0.0f);
  }
};

}  // namespace petrichor
