-- A minute's walk down Lamplighter Street and back, while the rain steps between dry and a cloudburst: what the
-- director is measured by.
--   petrichor render scripts/cinematics/walk_with_steps.lua --budget 66 --stats walk.json --out walk.mp4
cinematic { duration_s = 60, fps = 15, size = { 640, 360 }, render = "scripts/render/city.lua" }

local city = require("scenes.city")
local night = city.load("rain")
local weather = night.weather

local eye = world.spawn {
  name = "camera",
  camera = { vertical_fov_deg = 60, exposure_s = 1 / 60, exposure_ev100 = 2.8 },
  transform = {},
}

timeline(function()
  camera.path {
    { time_s = 0, position = { -1.5, 1.70, 23.0 }, target = { 0.4, 2.6, -6.0 }, fov = 60 },
    { time_s = 14, position = { -1.3, 1.70, 9.0 }, target = { 6.0, 2.6, -9.0 }, fov = 60 },
    { time_s = 24, position = { -1.0, 1.70, 1.0 }, target = { 14.0, 2.4, -4.0 }, fov = 60 },
    { time_s = 34, position = { -1.2, 1.70, -2.0 }, target = { -12.0, 2.6, -14.0 }, fov = 60 },
    { time_s = 44, position = { -1.4, 1.70, 4.0 }, target = { -8.0, 2.6, 24.0 }, fov = 60 },
    { time_s = 60, position = { -1.6, 1.70, 18.0 }, target = { 0.5, 2.8, 40.0 }, fov = 60 },
    camera = eye,
  }
end)

-- Every five seconds another rain, at once: nothing for the director to see coming.
timeline(function()
  local steps = { 0, 5, 50, 10, 100, 2, 0, 25, 100, 5, 50, 10 }
  for _, rate in ipairs(steps) do
    weather.emitter.rain_mm_per_hour = rate
    wait(5)
  end
end)

timeline(function()
  while true do
    wait(9)
    tween(weather.wind, "velocity_mps", { 5.0, 0, 1.5 }, 2, "smooth")
    wait(3)
    tween(weather.wind, "velocity_mps", { 1.0, 0, 0.5 }, 3, "smooth")
  end
end)
