#pragma once
// Water on and in a piece of surface: a film that runs off and pores under it. In closed form while rain, evaporation
// and slope stay as they are, so that any step gives the same film.

namespace petrichor {

// What holds while a film is advanced. Rates in m/s of water over the surface itself.
struct FilmLaw {
  double supply_mps = 0.0;       // rain that arrives
  double evaporation_mps = 0.0;  // of a wet surface
  double drain_per_m2s = 0.0;    // c of dh/dt = -c h^3
  double pores_m = 0.0;          // water that the pores hold when full
  double absorption_mps = 0.0;   // at most, while they are not
};

struct Film {
  double film_m = 0.0;   // on the surface, mean over it
  double pores_m = 0.0;  // in it
};

// Laminar flow down a slope (shared physics, section 9: h = (3 nu q / (g S))^(1/3)): q = g S h^3 / (3 nu), shared out
// over the length that drains, so c = g S / (3 nu L). slope: sine of the inclination.
double drain_per_m2s(double slope, double length_m);
// Mean speed of such a film, m/s: g S h^2 / (3 nu).
double film_speed_mps(double slope, double film_m);

// dh/dt = rate - c h^3 from h >= 0, after dt_s >= 0, in closed form (its inverse is; a root gives h, to 1e-9).
// Where it reaches 0 earlier (rate < 0) it stays there and *left_s (if given) is the time after that.
double drained_film_m(double film_m, double rate_mps, double drain_per_m2s, double dt_s, double* left_s = nullptr);

// Pores take what arrives before there is a film, at most absorption_mps; with rain or a film on them they never dry.
// A film evaporates at the full rate; pores, once bare, at a rate that falls with what is left in them (the
// falling-rate period of drying porous bodies), so they fill first and dry last.
Film advance(Film, const FilmLaw&, double dt_s);

// Of a wet surface, m/s of water: h_m (rho_s(T) - RH rho_s(T)) / rho_w with h_m 5 to 10 mm/s by the wind (shared
// physics, section 9); rho_s by Magnus' formula.
double evaporation_mps(double temperature_c, double humidity, double wind_mps);

}  // namespace petrichor
