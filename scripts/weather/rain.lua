-- Steady rain: what people mean by "it is raining".
return {
  emitter = { rain_mm_per_hour = 8 },
  wind = { velocity_mps = { 1.5, 0, 0.6 }, gust_mps = 0.8, swirl_mps = 0.5 },
  fog = { extinction_per_km = 2 },
}
