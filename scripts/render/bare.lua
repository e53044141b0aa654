-- The least frame that shows rain: sky, drops, tone map. For measuring the drop field alone.
return {
  resources = {
    colour  = { format = "rgba16f" },
    picture = { format = "rgba8" },
  },
  passes = {
    { pass = "sky", colour = "colour" },
    { pass = "rain_cells" },
    { pass = "rain_splat" },
    { pass = "rain_composite", colour = "colour" },
    { pass = "tonemap8", colour = "colour", picture = "picture" },
  },
  output = "picture",
  linear_output = "colour",
}
