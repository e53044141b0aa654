-- The first rain: a walk up Lamplighter Street to the toy shop, from the first drizzle to the downpour.
cinematic { duration_s = 10, fps = 24, size = { 640, 360 }, render = "scripts/render/city.lua" }

local city = require("scenes.city")
local night = city.load("drizzle")
local weather = night.weather

local eye = world.spawn {
  name = "camera",
  camera = { vertical_fov_deg = 52, exposure_s = 1 / 48 },  -- a film camera's shutter: half of each frame's time
  transform = { position_m = { -1.3, 1.6, 19 } },
}

-- Past the lamp on the left (z = 13.5) and under the one at the crossing, to the shop on the far corner.
timeline(function()
  camera.path {
    { time_s = 0, position = { -1.6, 1.60, 20.0 }, target = { 0.6, 3.2, -6.0 }, fov = 50 },
    { time_s = 3, position = { -1.2, 1.64, 15.6 }, target = { 2.4, 3.1, -7.0 }, fov = 50 },
    { time_s = 6, position = { -0.2, 1.60, 10.4 }, target = { 5.6, 2.9, -7.6 }, fov = 51 },
    { time_s = 8.5, position = { 0.8, 1.63, 6.2 }, target = { 8.6, 2.7, -7.8 }, fov = 52 },
    { time_s = 10, position = { 1.3, 1.60, 4.4 }, target = { 9.4, 2.6, -7.8 }, fov = 52 },
    camera = eye,
  }
end)

-- The rain: a drizzle, a moment's breath, and then it comes down.
timeline(function()
  tween(weather.emitter, "rain_mm_per_hour", 2.5, 2.5, "in")
  go(function() tween(weather.fog, "extinction_per_km", 5, 4, "smooth") end)
  tween(weather.emitter, "rain_mm_per_hour", 42, 4, "smooth")
end)

-- One gust goes through it as it peaks.
timeline(function()
  wait(4.5)
  tween(weather.wind, "velocity_mps", { 4.5, 0, 1.5 }, 1.5, "smooth")
  tween(weather.wind, "velocity_mps", { 1.8, 0, 0.6 }, 2.5, "smooth")
end)
