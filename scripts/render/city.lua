-- The frame: what is drawn, in which order, from what into what. Read at start and again whenever this file is saved.
--
-- A pass names its slots and the resource in each. It runs where somebody reads what it writes and where the scene
-- asks for it (no rain: no rain pass; clear air: no airlight). `petrichor info` lists all passes with their slots and
-- parameters, `petrichor info --graph frame.dot` draws this frame.
--
-- Light is in cd/m2 up to the tone map; the camera's exposure_ev100 says what is white.

local resources = {
  -- The G-buffer: what the camera sees of surfaces (systems/geometry/gbuffer.glsl).
  depth    = { format = "depth32f" },
  albedo   = { format = "rgba8" },
  normal   = { format = "rgba16" },           -- with roughness and occlusion
  emissive = { format = "r11f_g11f_b10f" },

  -- Where water stands and what gets wet: hollows and kinds of material, and what lies there now.
  water_mask = { format = "rg8" },
  water      = { format = "rg16f" },             -- mm of standing water, mm of film
  puddle_list = { format = "none" },
  ripples    = { format = "rgba16f", width = 256, height = 256, layers = 3, mips = 2 },  -- shared, near, drips
  overhead   = { format = "rgba16f", width = 128, height = 128, persistent = true },  -- light from above, for splashes
  mirrors    = { format = "rgba16f", scale = 1 / 2, layers = 2, mips = 6 },
  probes     = { format = "rgba16f", width = 448, height = 65, layers = 4 },
  reflections = { format = "rgba16f", scale = 1 / 2 },
  lamp_highlights = { format = "none" },  -- connected, pass shade leaves them to pass reflections where that draws lamps

  -- Kept while nothing moves.
  -- Shelter from rain and snow; a layer for each map that occlusion=jittered may draw.
  occlusion_map = { format = "depth32f", width = 1024, height = 1024, layers = 8, persistent = true },
  shadow_atlas  = { format = "rgba32f", width = 2048, height = 2048, persistent = true },   -- 16 lamps of 512x512

  environment = { format = "rgba16f", width = 448, height = 65 },  -- the street all round, blurred in steps
  light_lists = { format = "rgba32ui", scale = 1 / 8 },            -- a bit a lamp, for every 8x8 pixels
  colour      = { format = "rgba16f" },                            -- the picture as light
  airlight    = { format = "rgba16f", scale = 1 / 4 },             -- lamps glowing in the mist
  rain_light  = { format = "rgba16f", scale = 1 / 24, layers = 12 },  -- lamps on drops that are not known one by one
  snow_light  = { format = "rgba16f", scale = 1 / 24, layers = 12 },  -- and on flakes
  near_drops  = { format = "none" },        -- drops that rain_splat leaves to pass near_drops
  near_environment = { format = "none" },
  bloom       = { format = "rgba16f", scale = 1 / 2, mips = 6 },   -- what the lens scatters
  display     = { format = "rgba16f" },                            -- the picture as seen, before antialiasing
  picture     = { format = "rgba8" },
}

local passes = {
  -- Geometry: the only rasterised passes.
  { pass = "gbuffer", depth = "depth", albedo = "albedo", normal = "normal", emissive = "emissive",
    water_mask = "water_mask" },
  -- tolerance_deg: while the wind turns, the map is drawn anew once it has turned so far; half of it at 5 m is 9 cm.
  { pass = "occlusion_map", occlusion_map = "occlusion_map", parameters = { tolerance_deg = 2 } },
  { pass = "shadow_maps", shadow_atlas = "shadow_atlas" },

  -- Films of water and puddles, laid over the G-buffer.
  { pass = "puddles", puddle_list = "puddle_list" },
  { pass = "ripples", ripples = "ripples", parameters = { software_level = 1 } },
  { pass = "wet_surfaces", depth = "depth", albedo = "albedo", normal = "normal", water_mask = "water_mask",
    occlusion_map = "occlusion_map", ripples = "ripples", puddle_list = "puddle_list", water = "water" },

  -- Light. threshold: of a white pixel; a lamp that adds less to a tile of pixels is left out there.
  { pass = "environment", environment = "environment", shadow_atlas = "shadow_atlas" },
  { pass = "probes", probes = "probes", shadow_atlas = "shadow_atlas" },
  { pass = "light_lists", depth = "depth", albedo = "albedo", normal = "normal", shadow_atlas = "shadow_atlas",
    light_lists = "light_lists", parameters = { threshold = 0.003 } },
  { pass = "shade", depth = "depth", albedo = "albedo", normal = "normal", emissive = "emissive",
    light_lists = "light_lists", shadow_atlas = "shadow_atlas", environment = "environment", colour = "colour",
    highlights = "lamp_highlights" },
  -- software_share: of the picture's width and height that software OpenGL draws.
  { pass = "mirrors", light_lists = "light_lists", shadow_atlas = "shadow_atlas", environment = "environment",
    mirrors = "mirrors", parameters = { software_share = 2 } },
  -- What wet ground mirrors, in place of the captured surroundings; by rays through the picture, or by stand-ins.
  { pass = "reflections", depth = "depth", albedo = "albedo", normal = "normal", emissive = "emissive",
    highlights = "lamp_highlights", environment = "environment", colour = "colour", reflections = "reflections" },
  { pass = "reflections_over", colour = "colour", depth = "depth", albedo = "albedo", normal = "normal",
    emissive = "emissive", environment = "environment", mirrors = "mirrors", probes = "probes",
    reflections = "reflections" },
  -- Rain on marked things (component rain_catcher): rings of splatter, and mist of splashes along their outlines.
  { pass = "splatter", colour = "colour", depth = "depth", normal = "normal", occlusion_map = "occlusion_map",
    environment = "environment" },
  { pass = "halos", colour = "colour", depth = "depth", occlusion_map = "occlusion_map", environment = "environment" },

  { pass = "glass", colour = "colour", depth = "depth", environment = "environment", mirrors = "mirrors" },

  -- Air. forward: how much mist scatters ahead; 0 evenly, towards 1 tighter and brighter halos.
  { pass = "airlight", depth = "depth", light_lists = "light_lists", shadow_atlas = "shadow_atlas", airlight = "airlight",
    parameters = { forward = 0.8 } },
  { pass = "atmosphere", colour = "colour", depth = "depth", airlight = "airlight", environment = "environment" },

  -- Rain, by whichever technique is chosen (`petrichor info` lists them); the passes of the others do not run.
  { pass = "rain_light", rain_light = "rain_light" },

  -- The drop field: its cells in view, their drops as streaks, and those laid over the picture.
  { pass = "rain_cells" },
  { pass = "rain_splat", depth = "depth", occlusion_map = "occlusion_map", near = "near_drops" },
  { pass = "rain_sprites", depth = "depth", occlusion_map = "occlusion_map" },
  -- Splashes where the drops land, and what lights them that is no lamp: into the same sums. What software OpenGL affords:
  -- how many, out to how many metres, with droplets to how many.
  { pass = "splash_overhead", overhead = "overhead", occlusion_map = "occlusion_map" },
  { pass = "splash_list", depth = "depth", normal = "normal", occlusion_map = "occlusion_map", water = "water",
    overhead = "overhead", environment = "environment",
    parameters = { software_most = 2000, software_reach = 8, software_secondary_reach = 1.5 } },
  { pass = "splash_draw", depth = "depth" },
  -- Drips from edges, into the same sums; and near ones (or billboards) as pictures of drops, over the picture.
  { pass = "drips", depth = "depth" },
  { pass = "rain_composite", colour = "colour", environment = "environment" },
  { pass = "drips_over", colour = "colour", depth = "depth", environment = "environment" },

  { pass = "double_cone", colour = "colour", depth = "depth", occlusion_map = "occlusion_map",
    environment = "environment", rain_light = "rain_light" },
  { pass = "layered_composite", colour = "colour", depth = "depth", occlusion_map = "occlusion_map",
    environment = "environment", rain_light = "rain_light" },
  -- Drops near the eye show the world: captured in six faces (of so many pixels), and those drops.
  { pass = "near_environment", near_environment = "near_environment", shadow_atlas = "shadow_atlas",
    parameters = { face = 128, face_software = 64 } },
  { pass = "near_drops", colour = "colour", near = "near_drops", near_environment = "near_environment", depth = "depth",
    occlusion_map = "occlusion_map" },

  -- Snow, likewise. snow_light is for the cone, which does not know its flakes one by one.
  { pass = "snow_light", snow_light = "snow_light" },
  { pass = "snow_cells" },
  { pass = "snow_field", depth = "depth", occlusion_map = "occlusion_map" },
  { pass = "snow_composite", colour = "colour", environment = "environment" },
  { pass = "snow_cone", colour = "colour", depth = "depth", occlusion_map = "occlusion_map",
    environment = "environment", snow_light = "snow_light" },

  -- An artist's own pass: a compute shader of yours over any resource. Say this makes reds burn (image "picture_in" of
  -- the shader is read and written; parameters are its uniforms; every pixel is one invocation):
  --   { compute = "my_shaders/burn_reds.comp.glsl", name = "burn_reds",
  --     modify = { picture_in = "colour" }, parameters = { strength = 0.3 } },

  -- From light to picture.
  { pass = "bloom", colour = "colour", bloom = "bloom", parameters = { spread = 0.6 } },
  { pass = "tonemap", colour = "colour", bloom = "bloom", display = "display" },
  { pass = "antialias", display = "display", picture = "picture" },
}

return { resources = resources, passes = passes, output = "picture", linear_output = "colour" }
