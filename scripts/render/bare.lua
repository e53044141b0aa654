-- The least frame that shows rain: sky, drops, tone map. For measuring the drop field alone.
return {
  resources = {
    colour  = { format = "rgba16f" },
    picture = { format = "rgba8" },
    near_drops = { format = "none" },
    near_environment = { format = "none" },
    snow_light = { format = "rgba16f", scale = 1 / 16, layers = 12 },
    rain_light = { format = "rgba16f", scale = 1 / 16, layers = 12 },
  },
  passes = {
    { pass = "sky", colour = "colour" },
    { pass = "rain_light", rain_light = "rain_light" },
    { pass = "rain_cells" },
    { pass = "rain_splat", near = "near_drops" },
    { pass = "rain_composite", colour = "colour" },
    { pass = "layered_composite", colour = "colour", rain_light = "rain_light" },
    { pass = "near_environment", near_environment = "near_environment" },
    { pass = "near_drops", colour = "colour", near = "near_drops", near_environment = "near_environment" },
    { pass = "snow_light", snow_light = "snow_light" },
    { pass = "snow_cells" },
    { pass = "snow_field" },
    { pass = "snow_composite", colour = "colour" },
    { pass = "tonemap8", colour = "colour", picture = "picture" },
  },
  output = "picture",
  linear_output = "colour",
}
