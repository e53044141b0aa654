-- Weather as an entity (emitter, wind, fog) and the change from one preset of scripts/weather/ to another.
local weather = {}

-- weather.spawn("rain") -> the entity that holds it
function weather.spawn(name)
  local preset = require("weather." .. name)
  return world.spawn {
    name = "weather", emitter = preset.emitter, wind = preset.wind, fog = preset.fog,
    snowfall = preset.snowfall or { snow_mm_per_hour = 0 },
  }
end

-- Every field of the preset moves to its new value in so many seconds, all of them at once; does not wait.
function weather.change(entity, name, seconds)
  local preset = require("weather." .. name)
  if not preset.snowfall then
    go(function() tween(entity.snowfall, "snow_mm_per_hour", 0, seconds, "smooth") end)
  end
  for component, fields in pairs(preset) do
    for field, value in pairs(fields) do
      go(function() tween(entity[component], field, value, seconds, "smooth") end)
    end
  end
end

return weather
