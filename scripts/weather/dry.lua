-- A clear night after the rain.
return {
  emitter = { rain_mm_per_hour = 0 },
  wind = { velocity_mps = { 0.5, 0, 0.2 }, gust_mps = 0.2, swirl_mps = 0.1 },
  fog = { extinction_per_km = 1 },
}
