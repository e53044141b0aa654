-- Any model in the rain: `petrichor render MODEL.glb` and `petrichor play MODEL.glb` run this with the model's
-- path in args.model.
local framing = require("lib.framing")
local weather = require("lib.weather")

local model = world.model(args.model)

-- What draws nothing (lights alone, an empty scene) has no bounds: look at the origin, then.
local has_bounds, low, high = pcall(model.bounds, model)
if not has_bounds then low, high = vec3(-1, 0, -1), vec3(1, 2, 1) end

local fov_deg = 45
local position, centre, distance, gap = framing.of_box(low, high, { fov_deg = fov_deg })

-- Rain falls between the camera and the model too, so the near plane stays close to the lens.
local near_m = math.min(math.max(gap * 0.25, 0.001), 0.05)
local camera = world.spawn {
  name = "camera",
  camera = { vertical_fov_deg = fov_deg, near_m = near_m, exposure_s = 1 / 60, exposure_ev100 = 2 },
  transform = { position_m = position, orientation = look_at(position, centre) },
}

-- In the sandbox the camera can be flown.
camera.walker = { flying = true, fly_mps = math.min(math.max(distance * 0.5, 0.5), 200) }
local ahead = centre - position
camera.walker.yaw_deg = math.deg(math.atan(ahead.x, -ahead.z))
camera.walker.pitch_deg = math.deg(math.atan(ahead.y, math.sqrt(ahead.x ^ 2 + ahead.z ^ 2)))

world.spawn { name = "sky", sky = { ambient = 1 } }

-- The moon through thin cloud, twenty times as bright as it is, so that what no lamp reaches still has a shape.
world.spawn {
  name = "moon",
  light = { kind = "directional", colour = { 0.62, 0.75, 1 }, intensity_cd = 5, casts_shadow = true },
  transform = { orientation = look_at({ 3, 5, -1 }, { 0, 0, 0 }) },
}

-- A model that brings no light gets a warm lamp beside the camera, and one behind the model, against which the
-- rain shows. A lamp of I candela gives I / d^2 lux at d metres: 7 lux on a grey surface (0.18) is 0.4 cd/m2,
-- which a camera at EV 2 shows as a little under middle grey (0.5 cd/m2).
if model:count("light") == 0 then
  local function lamp(name, offset, lux, colour, casts_shadow)
    local at = centre + offset * distance
    local d2 = offset.x ^ 2 + offset.y ^ 2 + offset.z ^ 2
    world.spawn {
      name = name,
      light = {
        colour = colour,
        intensity_cd = math.min(lux * d2 * distance ^ 2, 1e9),
        source_radius_m = math.min(0.02 * distance, 10),
        casts_shadow = casts_shadow,
      },
      transform = { position_m = at },
    }
  end
  lamp("key lamp", vec3(-0.25, 0.8, 0.95), 7, { 1, 0.82, 0.6 }, true)
  lamp("back lamp", vec3(-0.62, 0.34, -0.7), 16, { 1, 0.7, 0.4 }, false)
end

-- A model that brings bright light (the sun of an exporter, a studio lamp) is exposed for it: a grey surface (0.18) in E
-- lux has 0.18 E / pi cd/m2, and EV 0 shows 0.125 cd/m2 as middle grey. Lamps are taken at their own node's place.
local brightest_lux = 0
model:each("light", function(e)
  local lux = e.light.intensity_cd
  if e.light.kind ~= "directional" then
    local offset = e.transform.position_m - centre
    local d2 = offset.x ^ 2 + offset.y ^ 2 + offset.z ^ 2
    lux = lux / math.max(d2, (0.3 * distance) ^ 2, 1e-6)
  end
  brightest_lux = math.max(brightest_lux, lux)
end)
if brightest_lux > 0 then
  camera.camera.exposure_ev100 = math.min(math.max(math.log(0.18 * brightest_lux / math.pi / 0.125, 2), 2), 18)
end

local sky_weather = weather.spawn("rain")
sky_weather.emitter.rain_mm_per_hour = 20
-- Mist hides what is far; a model that is seen from far away stands in clearer air.
sky_weather.fog.extinction_per_km = math.min(2, 200 / distance)

for key, name in pairs { "drizzle", "rain", "downpour", "dry" } do
  on("key:" .. key, function() weather.change(sky_weather, name, 3) end)
end
