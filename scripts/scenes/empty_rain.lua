-- Nothing but rain before a camera: what `petrichor bench rain` measures.
cinematic { duration_s = 10, fps = 60, size = { 1280, 720 } }

world.spawn { name = "camera", camera = {}, transform = { position_m = { 0, 1.7, 0 } } }
world.spawn { name = "sky", sky = {} }
world.spawn { name = "lamp", light = { intensity_cd = 600 }, transform = { position_m = { 2, 4.5, -8 } } }
world.spawn { name = "rain", emitter = { rain_mm_per_hour = 25 } }
