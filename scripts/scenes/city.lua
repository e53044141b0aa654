-- The town at night, with its sky and its weather. Other scripts want its parts:
--   local city = require("scenes.city")
--   local night = city.load("drizzle")   -- night.model, night.sky, night.weather
-- Run by itself it is a picture of the crossing in the rain.
local is_required = ... ~= nil
local weather = require("lib.weather")

local city = {}

function city.load(weather_name)
  local model = world.model("content/city.glb")
  local sky = world.spawn {
    name = "sky",
    sky = {
      zenith_cd_m2 = { 0.004, 0.006, 0.012 },
      horizon_cd_m2 = { 0.05, 0.04, 0.03 },  -- sodium lamps under low cloud
      glow_height = 0.25,
    },
  }
  return { model = model, sky = sky, weather = weather.spawn(weather_name or "rain") }
end

if not is_required then
  local night = city.load("rain")
  local view = night.model:find("view_crossing")
  if view and view:has("camera") then
    view.camera.active = true
  else
    world.spawn { name = "camera", camera = {}, transform = { position_m = { -1.3, 1.6, 25 } } }
  end
end

return city
