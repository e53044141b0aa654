-- The toy shop: forty seconds round its corner, from the first drops to the downpour to the dripping after it. Each shot
-- shows one thing that rain does where it lands.
--   petrichor render scripts/cinematics/toyshop.lua --out toyshop.mp4
cinematic { duration_s = 40, fps = 24, size = { 640, 360 }, render = "scripts/render/city.lua" }

local city = require("scenes.city")
local night = city.load("dry")
local weather = night.weather

local eye = world.spawn {
  name = "camera",
  camera = { exposure_s = 1 / 48, exposure_ev100 = 2.6 },
  transform = {},
}

-- From which second on, from where to where the camera moves, and what it looks at.
local shots = {
  -- The dry crossing; the first drops.
  { at = 0, from = { -1.6, 1.60, 16.0 }, to = { -1.1, 1.60, 12.5 }, look = { 6.5, 3.0, -7.5 }, fov = 48 },
  -- A hollow in the road fills; rings on it, the shop's neon in them.
  { at = 6, from = { 3.4, 0.42, 3.6 }, to = { 3.6, 0.38, 2.9 }, look = { 6.6, 1.6, -6.0 }, fov = 44 },
  -- Under the awning: the edge drips, the pavement is dry up to the wet line.
  { at = 12, from = { 15.6, 1.55, -6.05 }, to = { 14.6, 1.50, -6.0 }, look = { 9.0, 1.4, -4.2 }, fov = 56 },
  -- The downpour against the headlights of a car that comes: splashes, streaks, mist on its roof.
  { at = 18, from = { -3.4, 0.55, 6.0 }, to = { -3.2, 0.50, 5.0 }, look = { -1.6, 0.9, -16.0 }, fov = 42 },
  -- The waiting taxi: rings on its bonnet, mist along its outline, the street's lights in its doors.
  { at = 25, from = { 4.4, 1.25, 9.4 }, to = { 3.6, 1.20, 9.0 }, look = { 1.9, 0.8, 13.6 }, fov = 46 },
  -- Neon in the wet street.
  { at = 30, from = { 2.6, 0.75, 5.2 }, to = { 3.4, 0.70, 4.0 }, look = { 8.6, 2.0, -7.6 }, fov = 46 },
  -- After the rain: the awning drips on, and the street lies still.
  { at = 35, from = { 5.2, 1.45, -3.0 }, to = { 4.4, 1.60, -1.2 }, look = { 9.0, 2.1, -10.0 }, fov = 50 },
}

timeline(function()
  for i, shot in ipairs(shots) do
    local length = (shots[i + 1] and shots[i + 1].at or 40) - shot.at
    wait_until(shot.at)
    go(function()
      camera.path {
        { time_s = 0, position = shot.from, target = shot.look, fov = shot.fov },
        { time_s = length - 1 / 100, position = shot.to, target = shot.look, fov = shot.fov },
        camera = eye,
      }
    end)
  end
end)

-- The rain: first drops, steady, a cloudburst, and over.
timeline(function()
  wait(2)
  tween(weather.emitter, "rain_mm_per_hour", 1.5, 3, "in")
  tween(weather.emitter, "rain_mm_per_hour", 10, 6, "smooth")
  wait_until(16)
  go(function() tween(weather.wind, "velocity_mps", { 3, 0, 1 }, 4, "smooth") end)
  tween(weather.emitter, "rain_mm_per_hour", 50, 4, "smooth")
  wait_until(32)
  go(function() tween(weather.wind, "velocity_mps", { 0.5, 0, 0.2 }, 3, "smooth") end)
  tween(weather.emitter, "rain_mm_per_hour", 0, 3, "smooth")
end)

-- The car drives up the street in the fourth shot: its body and its lamps together.
timeline(function()
  local parts = {}
  for _, entity in ipairs(night.model) do
    if type(entity.name) == "string" and entity.name:find("^coming_car") then parts[#parts + 1] = entity end
  end
  wait_until(18)
  for _, part in ipairs(parts) do
    local p = part.transform.position_m
    go(function() tween(part.transform, "position_m", { p.x, p.y, p.z + 21 }, 7, "out") end)
  end
end)
