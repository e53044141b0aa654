-- The sandbox: walk through the town and choose the weather.
local city = require("scenes.city")
local weather = require("lib.weather")

local night = city.load("rain")

-- Begin where the town says one can stand.
local start = night.model:find("walker_start")
local ground = start and start.transform.position_m or vec3(0, 0.1, 22)
local walker = world.spawn {
  name = "walker",
  walker = { eye_height_m = 1.7, yaw_deg = 8 },
  camera = { vertical_fov_deg = 60, exposure_s = 1 / 60 },
  transform = { position_m = ground + vec3(0, 1.7, 0) },
}

-- Keys 1 to 5; anything else may emit the same events.
local presets = { "drizzle", "rain", "downpour", "dry", "snow" }
for key, name in pairs(presets) do
  on("key:" .. key, function() emit("weather:" .. name) end)
  on("weather:" .. name, function() weather.change(night.weather, name, 4) end)
end
