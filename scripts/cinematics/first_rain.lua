-- The first rain: a walk up Lamplighter Street to the toy shop, from the first drizzle to the downpour.
cinematic { duration_s = 10, fps = 24, size = { 640, 360 }, render = "scripts/render/city.lua" }

local city = require("scenes.city")
local night = city.load("drizzle")
local weather = night.weather

local eye = world.spawn {
  name = "camera",
  -- A film camera's shutter is open for half of each frame. Exposed for the lamps, so that the night stays dark.
  camera = { exposure_s = 1 / 48, exposure_ev100 = 2.8 },
  transform = {},
}

-- Past the lamp on the left (z = 13.5), with the one at the crossing between us and the shop on the far corner:
-- against it the streaks flare when the downpour comes.
timeline(function()
  camera.path {
    { time_s = 0, position = { -1.7, 1.60, 23.0 }, target = { 0.4, 3.2, -6.0 }, fov = 48 },
    { time_s = 3, position = { -1.6, 1.64, 19.6 }, target = { 2.0, 3.1, -7.0 }, fov = 48 },
    { time_s = 6, position = { -1.3, 1.60, 14.8 }, target = { 4.8, 3.1, -7.6 }, fov = 50 },
    { time_s = 8.5, position = { -0.9, 1.63, 11.0 }, target = { 8.2, 3.1, -7.8 }, fov = 51 },
    { time_s = 10, position = { -0.9, 1.60, 9.4 }, target = { 9.4, 3.0, -7.8 }, fov = 52 },
    camera = eye,
  }
end)

-- As film crews light rain: one cool lamp, high behind it, so that the streaks flare against the dark.
local from, to = { 1.5, 25, -36 }, { 1.5, 2, 4 }
world.spawn {
  name = "backlight",
  transform = { position_m = from, orientation = look_at(from, to) },
  light = {
    kind = "spot", colour = { 0.72, 0.85, 1.0 }, intensity_cd = 16000, inner_cone_deg = 8, outer_cone_deg = 26,
    source_radius_m = 0.5, casts_shadow = true,
  },
}

-- The rain: a drizzle, a moment's breath, and then it comes down.
timeline(function()
  tween(weather.emitter, "rain_mm_per_hour", 2.5, 2.5, "in")
  go(function() tween(weather.fog, "extinction_per_km", 1.2, 4, "smooth") end)
  tween(weather.emitter, "rain_mm_per_hour", 42, 4, "smooth")
end)

-- One gust goes through it as it peaks.
timeline(function()
  wait(4.5)
  tween(weather.wind, "velocity_mps", { 4.5, 0, 1.5 }, 1.5, "smooth")
  tween(weather.wind, "velocity_mps", { 1.8, 0, 0.6 }, 2.5, "smooth")
end)
