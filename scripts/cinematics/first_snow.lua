-- The first snow: the town grown quiet, a slow walk along Lamplighter Street under the lamps.
cinematic { duration_s = 10, fps = 24, size = { 640, 360 }, render = "scripts/render/city.lua" }

local city = require("scenes.city")
local night = city.load("snow")
local weather = night.weather

local eye = world.spawn {
  name = "camera",
  camera = { exposure_s = 1 / 48, exposure_ev100 = 2.8 },
  transform = {},
}

timeline(function()
  camera.path {
    { time_s = 0, position = { -1.7, 1.60, 23.0 }, target = { 0.4, 3.2, -6.0 }, fov = 48 },
    { time_s = 5, position = { -1.6, 1.62, 20.4 }, target = { 1.4, 3.2, -6.6 }, fov = 48 },
    { time_s = 10, position = { -1.4, 1.60, 17.6 }, target = { 3.0, 3.1, -7.2 }, fov = 49 },
    camera = eye,
  }
end)

-- A few flakes, then many; a breath of wind goes through them.
timeline(function()
  tween(weather.snowfall, "snow_mm_per_hour", 2.2, 7, "smooth")
end)
timeline(function()
  wait(5)
  tween(weather.wind, "velocity_mps", { 0.15, 0, 1.5 }, 1.5, "smooth")
  tween(weather.wind, "velocity_mps", { 0.05, 0, 0.4 }, 2.5, "smooth")
end)
