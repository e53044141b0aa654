#include "systems/wetness/history.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "systems/drops/drop_sizes.hpp"

namespace petrichor {
namespace {

constexpr double merge_s = 0.25;           // changes of the rate that lie closer are taken as their mean
constexpr double run_length_m = 3.0;       // half a street, a storey
constexpr double pores_full_m = 0.12e-3;   // water in the skin of a surface of porosity 1 that light gets to
constexpr double absorption_mps = 1.4e-5;  // 50 mm/h: pores take any rain but a downpour
constexpr double dry_film_m = 1e-6, dry_pores = 0.01;  // less is not seen
constexpr double humidity_of_rain = 0.95;
constexpr double mps_of_mm_per_hour = 1e-3 / 3600.0;

std::size_t cell(int remembered, int porosity, int slope, int j, int i) {
  return ((static_cast<std::size_t>(porosity) * film_slopes.size() + static_cast<std::size_t>(slope)) *
              static_cast<std::size_t>(remembered) +
          static_cast<std::size_t>(j)) *
             film_exposures +
         static_cast<std::size_t>(i);
}

template <class Each>
void each_cell(int remembered, Each each) {
  for (int q = 0; q < film_porosities; ++q)
    for (int s = 0; s < static_cast<int>(film_slopes.size()); ++s)
      for (int j = 0; j < remembered; ++j)
        for (int i = 0; i < film_exposures; ++i) each(cell(remembered, q, s, j, i), q, s, j, i);
}

// Between two moments at the mean rate since the anchor.
Film advanced(const WetnessHistory& h, const Film& from, int porosity, int slope, int exposure, double dt_s,
              double rate_mps) {
  FilmLaw law = film_law(porosity, slope);
  law.supply_mps = rate_mps * exposure_of(exposure, film_exposures);
  law.evaporation_mps = h.evaporation_mps;
  return advance(from, law, dt_s * h.pace);
}

// Mean since the anchor; the rate now at the anchor itself.
double mean_rate_mps(const WetnessHistory& h, double time_s) {
  if (!h.raining) return 0.0;
  const double now = h.rain.rain_mm_per_hour * mps_of_mm_per_hour, since = time_s - h.anchor_s;
  return since > 0.0 ? (h.rain_m + now * (time_s - h.time_s)) / since : now;
}

void anchor(WetnessHistory& h, double time_s) {
  const double dt = time_s - h.anchor_s, rate = mean_rate_mps(h, time_s);
  if (dt > 0.0 && h.ever_wet) {
    each_cell(h.remembered, [&](std::size_t at, int q, int s, int, int i) {
      h.films[at] = advanced(h, h.films[at], q, s, i, dt, rate);
    });
  }
  h.anchor_s = h.time_s = time_s;
  h.rain_m = 0.0;
}

// Films of a place whose exposure along the fall of now, and before, is that of the remembered one: the diagonal.
Film before_turning(const WetnessHistory& h, int q, int s, double exposure) {
  const auto index = [&](int count) {
    return std::clamp(std::cbrt(exposure / most_exposure) * (count - 1), 0.0, count - 1.0);
  };
  const double x = index(film_exposures), y = h.remembered > 1 ? index(h.remembered) : 0.0;
  const int i = std::min(static_cast<int>(x), film_exposures - 2);
  const int j = h.remembered > 1 ? std::min(static_cast<int>(y), h.remembered - 2) : 0;
  Film sum;
  for (int dj = 0; dj < (h.remembered > 1 ? 2 : 1); ++dj) {
    for (int di = 0; di < 2; ++di) {
      const double wy = h.remembered > 1 ? (dj ? y - j : 1.0 - (y - j)) : 1.0, w = (di ? x - i : 1.0 - (x - i)) * wy;
      const Film& f = h.films[cell(h.remembered, q, s, j + dj, i + di)];
      sum.film_m += w * f.film_m;
      sum.pores_m += w * f.pores_m;
    }
  }
  return sum;
}

// The fall of now becomes the remembered one.
void remember(WetnessHistory& h) {
  std::vector<Film> turned(static_cast<std::size_t>(film_porosities) * film_slopes.size() * remembered_exposures *
                           film_exposures);
  each_cell(remembered_exposures, [&](std::size_t at, int q, int s, int j, int) {
    turned[at] = before_turning(h, q, s, exposure_of(j, remembered_exposures));
  });
  h.films = std::move(turned);
  h.remembered = remembered_exposures;
  h.remembered_fall_mps = h.fall_mps;
  h.remembered_dose_m = h.dose_m;
  h.dose_m = 0.0;
}

// Nothing is left of what the remembered fall brought.
bool is_forgotten(const WetnessHistory& h) {
  double film = 0.0, pores = 0.0;
  each_cell(h.remembered, [&](std::size_t at, int q, int s, int j, int i) {
    const Film &f = h.films[at], &g = h.films[cell(h.remembered, q, s, 0, i)];
    if (j == 0) return;
    film = std::max(film, std::abs(f.film_m - g.film_m));
    pores = std::max(pores, std::abs(f.pores_m - g.pores_m));
  });
  return film < dry_film_m && pores < dry_pores * pores_full_m;
}

void forget(WetnessHistory& h) {
  std::vector<Film> kept(static_cast<std::size_t>(film_porosities) * film_slopes.size() * film_exposures);
  each_cell(1, [&](std::size_t at, int q, int s, int, int i) { kept[at] = h.films[cell(h.remembered, q, s, 0, i)]; });
  h.films = std::move(kept);
  h.remembered = 1;
  h.remembered_dose_m = 0.0;
}

bool is_dry(const WetnessHistory& h) {
  return std::all_of(h.films.begin(), h.films.end(),
                     [](const Film& f) { return f.film_m < dry_film_m && f.pores_m < dry_pores * pores_full_m; });
}

double angle_deg(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)));
}

bool same_fall(const Emitter& a, const Emitter& b) {
  return a.rain_mm_per_hour == b.rain_mm_per_hour && a.drop_sizes == b.drop_sizes && a.gamma_shape == b.gamma_shape &&
         a.minimum_diameter_mm == b.minimum_diameter_mm && a.maximum_diameter_mm == b.maximum_diameter_mm;
}

void set_air(WetnessHistory& h, const Wind& wind, const WetGround& ground) {
  // While rain falls the air is nearly full (shared physics, section 9: evaporation about 0 during rain). What is
  // sheltered then dries at drying_speed too, but nothing runs off faster than it does.
  const double humidity = h.raining ? std::max<double>(ground.humidity, humidity_of_rain) : ground.humidity;
  h.evaporation_mps = evaporation_mps(ground.temperature_c, humidity, glm::length(wind.velocity_mps)) *
                      (h.raining ? ground.drying_speed : 1.0);
  h.pace = h.raining ? 1.0 : ground.drying_speed;
}

}  // namespace

double exposure_of(int index, int count) {
  return count > 1 ? most_exposure * std::pow(static_cast<double>(index) / (count - 1), 3) : 0.0;
}

FilmLaw film_law(int porosity, int slope) {
  FilmLaw law;
  law.drain_per_m2s = drain_per_m2s(film_slopes[static_cast<std::size_t>(slope)], run_length_m);
  law.pores_m = pores_full_m * porosity / (film_porosities - 1);
  law.absorption_mps = absorption_mps;
  return law;
}

glm::dvec3 mean_rain_fall(const Emitter& emitter, const Wind& wind) {
  double water = 0.0, falls = 0.0;
  if (emitter.rain_mm_per_hour > 0.0f)
    for (const DropClass& c : make_drop_classes(emitter))
      water += rain_mm_per_hour(c), falls += rain_mm_per_hour(c) * c.fall_speed_mps;
  if (!(water > 0.0)) return {0.0, -1.0, 0.0};
  return glm::dvec3(wind.velocity_mps) - glm::dvec3(0.0, falls / water, 0.0);
}

WetnessHistory start_wetness(const Emitter& emitter, const Wind& wind, const WetGround& ground, double time_s) {
  WetnessHistory h;
  h.films.assign(static_cast<std::size_t>(film_porosities) * film_slopes.size() * film_exposures, {});
  h.anchor_s = h.time_s = time_s;
  h.rain = emitter;
  h.wind = wind;
  h.raining = emitter.rain_mm_per_hour > 0.0f;
  const float asked = ground.initial_wetness;
  const double wet = asked < 0.0f ? (h.raining ? 1.0 : 0.0) : asked;
  if (wet > 0.0 && !h.raining) h.rain.rain_mm_per_hour = 10.0f;
  h.fall_mps = mean_rain_fall(h.rain, wind);
  h.ever_wet = h.raining || wet > 0.0;
  if (wet > 0.0) {
    const double rate = h.rain.rain_mm_per_hour * mps_of_mm_per_hour;
    each_cell(1, [&](std::size_t at, int q, int s, int, int i) {
      const FilmLaw law = film_law(q, s);
      const double supply = rate * exposure_of(i, film_exposures);
      h.films[at] = {wet * std::cbrt(supply / law.drain_per_m2s), supply > 0.0 ? wet * law.pores_m : 0.0};
    });
    h.dose_m = wet * rate * forget_s;
  }
  set_air(h, wind, ground);
  return h;
}

void follow_rain(WetnessHistory& h, const Emitter& emitter, const Wind& wind, const WetGround& ground, double time_s) {
  const bool raining = emitter.rain_mm_per_hour > 0.0f;
  const double step_s = std::max(time_s - h.time_s, 0.0);
  // What fell since the last tick fell as it was then.
  const double fell_m = h.raining ? h.rain.rain_mm_per_hour * mps_of_mm_per_hour * step_s : 0.0;
  const double keep = std::exp(-step_s / forget_s);
  h.dose_m = h.dose_m * keep + fell_m;
  h.remembered_dose_m *= keep;
  const auto fly = [&](int slope) {
    const double rate = mean_rate_mps(h, time_s);
    const FilmLaw law = film_law(1, slope);
    // A film in balance with the rain of now, or the one that is left; a wall's is asked for at half exposure.
    const double steady = std::cbrt(rate * (slope == 2 ? 0.5 : 1.0) / law.drain_per_m2s);
    const double film = h.raining ? steady : film_at(h, 1, slope, 0, slope == 2 ? 12 : 15, time_s).film_m;
    return film_speed_mps(film_slopes[static_cast<std::size_t>(slope)], film) * step_s * h.pace;
  };
  if (h.ever_wet && step_s > 0.0) h.flown_m += glm::dvec2(fly(0), fly(2));
  h.rain_m += fell_m;
  h.time_s = time_s;

  const bool starts_or_stops = raining != h.raining;
  const bool other_rate = raining && emitter.rain_mm_per_hour != h.rain.rain_mm_per_hour;
  const double evaporation = h.evaporation_mps, pace = h.pace;
  const auto falls_otherwise = [&] { return !same_fall(emitter, h.rain) || wind.velocity_mps != h.wind.velocity_mps; };
  const bool turned = raining && (starts_or_stops || falls_otherwise());
  if (starts_or_stops || (other_rate && time_s - h.anchor_s >= merge_s)) anchor(h, time_s);
  h.raining = raining;
  set_air(h, wind, ground);
  if (h.evaporation_mps != evaporation || h.pace != pace) {
    // Up to now the air was as it was.
    const double new_evaporation = std::exchange(h.evaporation_mps, evaporation),
                 new_pace = std::exchange(h.pace, pace);
    if (!starts_or_stops) anchor(h, time_s);
    h.evaporation_mps = new_evaporation;
    h.pace = new_pace;
  }
  if (turned) {
    const glm::dvec3 fall = mean_rain_fall(emitter, wind);
    if (!h.ever_wet || is_dry(h) || angle_deg(fall, h.fall_mps) > turn_deg) {
      anchor(h, time_s);
      if (is_dry(h)) {
        if (h.remembered > 1) forget(h);
        h.dose_m = 0.0;
      } else if (h.remembered == 1 || h.dose_m > h.remembered_dose_m) {
        remember(h);
      }
      h.fall_mps = fall;
    }
    h.rain = emitter;
    h.wind = wind;
    h.ever_wet = true;
  }
  // Now and then: whether the remembered fall still shows.
  if (h.remembered > 1 && time_s - h.anchor_s >= 10.0) {
    anchor(h, time_s);
    if (is_forgotten(h)) forget(h);
  }
  if (h.ever_wet && !h.raining && time_s - h.anchor_s >= 10.0) {
    anchor(h, time_s);
    h.ever_wet = !is_dry(h);
  }
}

Film film_at(const WetnessHistory& h, int porosity, int slope, int remembered, int exposure, double time_s) {
  return advanced(h, h.films[cell(h.remembered, porosity, slope, remembered, exposure)], porosity, slope, exposure,
                  time_s - h.anchor_s, mean_rate_mps(h, time_s));
}

std::vector<glm::vec4> films_at(const WetnessHistory& h, double time_s) {
  std::vector<glm::vec4> all;
  all.reserve(static_cast<std::size_t>(film_porosities) * static_cast<std::size_t>(h.remembered) * film_exposures);
  for (int q = 0; q < film_porosities; ++q) {
    for (int j = 0; j < h.remembered; ++j) {
      for (int i = 0; i < film_exposures; ++i) {
        const std::array<Film, 3> f{film_at(h, q, 0, j, i, time_s), film_at(h, q, 1, j, i, time_s),
                                    film_at(h, q, 2, j, i, time_s)};
        const double full = film_law(q, 0).pores_m;
        all.emplace_back(f[0].film_m * 1e3, f[1].film_m * 1e3, f[2].film_m * 1e3,
                         full > 0.0 ? f[1].pores_m / full : 0.0);
      }
    }
  }
  return all;
}

}  // namespace petrichor
