#pragma once
// The sums that drops are drawn into by integer atomics (raster.glsl): optical depth and radiance of each pixel.
// Whoever draws single drops adds to them, pass rain_composite lays them over the picture and leaves them at zero.

#include "engine/gpu/objects.hpp"

namespace petrichor {

struct RainSums {
  Buffer optical_depth, radiance;
  Buffer streaks;  // see lists.hpp
  VertexArray no_vertices;
  int width = 0, height = 0;
  bool software = false;  // composite by blending, which software OpenGL likes better; set by who draws
};

// Makes them for that size, at zero, where they are missing, and binds them for raster.glsl.
void bind_rain_sums(RainSums&, int width, int height);

// By the name of the renderer of the current context.
bool is_software_gl();

}  // namespace petrichor
