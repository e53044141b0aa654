-- A quiet snowfall: large flakes, hardly any wind, clear air between them.
return {
  emitter = { rain_mm_per_hour = 0 },
  snowfall = { snow_mm_per_hour = 1.2 },
  -- Along the street: across it, the houses would keep it off.
  wind = { velocity_mps = { 0.05, 0, 0.35 }, gust_mps = 0.25, gust_period_s = 9, swirl_mps = 0.12 },
  fog = { extinction_per_km = 0.6 },
}
