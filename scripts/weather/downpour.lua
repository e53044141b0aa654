-- A cloudburst, with gusts that lean the streaks.
return {
  emitter = { rain_mm_per_hour = 50 },
  wind = { velocity_mps = { 3, 0, 1 }, gust_mps = 2.5, swirl_mps = 1 },
  fog = { extinction_per_km = 1.5 },
}
