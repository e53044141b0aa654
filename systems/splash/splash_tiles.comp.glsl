#version 450 core
// Which lamps light the splashes of each tile of ground, once for all columns that stand on it.
layout(local_size_x = 64) in;
#include "systems/splash/splash.glsl"
#include "systems/drops/cell_lights.glsl"

layout(std430, binding = SPLASH_TILES_BINDING) writeonly buffer SplashTiles { SplashTileGpu tiles[]; };

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= uint(SPLASH_TILES * SPLASH_TILES)) return;
  vec2 at = tiling.xy + (vec2(index % uint(SPLASH_TILES), index / uint(SPLASH_TILES)) + 0.5) * tiling.z;
  uint map = occlusion.counts.y;
  vec3 place = vec3(at.x, 0.0, at.y);
  float hit = occlusion_first_hit_m(map, place);
  float y = abs(hit) < 1e5 ? occlusion.fall_texel[map].y * hit : -1e4;
  place.y = y;
  SplashTileGpu tile;
  int count = lights_of_cell(place, 0.71 * tiling.z + 0.3, tile.lights);
  tile.light = vec4(float(count), y > -1e3 ? brightness_at(place, tile.lights, count) : 0.0, y, 0.0);
  tiles[index] = tile;
}
