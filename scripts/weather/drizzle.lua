-- Fine rain that hangs more than it falls, with mist between the lamps.
return {
  emitter = { rain_mm_per_hour = 1 },
  wind = { velocity_mps = { 0.8, 0, 0.3 }, gust_mps = 0.4, swirl_mps = 0.3 },
  fog = { extinction_per_km = 2 },
}
