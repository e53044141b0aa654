-- The least frame that shows rain: sky, drops, tone map. For measuring the drop field alone.
return {
  resources = {
    colour  = { format = "rgba16f" },
    picture = { format = "rgba8" },
    rain_light = { format = "rgba16f", scale = 1 / 16, layers = 12 },
  },
  passes = {
    { pass = "sky", colour = "colour" },
    { pass = "rain_light", rain_light = "rain_light" },
    { pass = "rain_cells" },
    { pass = "rain_splat" },
    { pass = "rain_composite", colour = "colour" },
    { pass = "tonemap8", colour = "colour", picture = "picture" },
  },
  output = "picture",
  linear_output = "colour",
}
