#version 450 core
// Goes through the columns of the field's cells, which lean as their class falls, and lists of each the few cells that
// hold what has just landed: those below the first surface under the sky, as the maps of shelter have it.
layout(local_size_x = 64) in;
#include "systems/splash/splash.glsl"
#include "systems/drops/cell_lights.glsl"

layout(std430, binding = SPLASH_TILES_BINDING) readonly buffer SplashTiles { SplashTileGpu tiles[]; };
layout(std430, binding = SPLASH_CELLS_BINDING) writeonly buffer SplashCells { SplashCellGpu cells[]; };
uniform uint candidates, cell_capacity;

const int most_levels = 128;
// Metres between questions to the map; a rail thinner than this may go without.
#ifdef SOFTWARE
const float sample_m = 0.7;
const int most_samples = 3;
#else
const float sample_m = 0.4;
const int most_samples = 6;
#endif

bool touches(vec3 centre, vec3 extent) {
  mat4 rows = transpose(frame.view_projection);
  vec4 planes[4] = vec4[](rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1]);
  for (int i = 0; i < 4; ++i)
    if (dot(planes[i].xyz, centre) + planes[i].w + dot(abs(planes[i].xyz), extent) < 0.0) return false;
  return dot(rows[3].xyz, centre) + rows[3].w + dot(abs(rows[3].xyz), extent) > frame.camera_world_m.w;
}

// Of this column among the columns of its layer: the cell at a level. Whole steps, so that each cell is in one column.
ivec2 lean(RainLayerGpu layer, int level) {
  vec2 slope = layer.velocity_diameter.xz / layer.velocity_diameter.y;
  return ivec2(floor(slope * float(level) + 0.5));
}

void main() {
  uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
  if (index >= candidates) return;
  uint l = find_layer(index);
  RainLayerGpu layer = layers[l];
  uint number = index - layer.box.w;
  ivec2 column = ivec2(number % layer.box.x, number / layer.box.x);
  int levels = min(int(layer.box.y), most_levels);
  float edge = layer.corner_edge.w;
  vec3 velocity = layer.velocity_diameter.xyz;
  vec2 slope = velocity.xz / velocity.y;
  float diameter = layer.velocity_diameter.w, speed = -velocity.y;
  vec2 corner = layer.corner_edge.xz + vec2(column) * edge;  // at level 0
  float base = layer.corner_edge.y, top = base + float(levels) * edge;
  // Rounding makes a leaning column half a cell wider to each side.
  vec2 pad = 0.5 * edge * min(abs(slope) * 1e6, vec2(1.0));
  vec2 low = corner - pad, high = corner + edge + pad;
  int across = clamp(int(ceil((high.x - low.x) / sample_m)), 1, most_samples);
  int along = clamp(int(ceil((high.y - low.y) / sample_m)), 1, most_samples);
  // All that it may ever hold: outside the view?
  vec2 leans = slope * (top - base);
  vec2 whole_low = low + min(leans, 0.0), whole_high = high + max(leans, 0.0);
  if (!touches(vec3(0.5 * (whole_low + whole_high), 0.5 * (base + top)).xzy,
               vec3(0.5 * (whole_high - whole_low), 0.5 * (top - base)).xzy)) return;
  vec2 closest_xz = max(max(whole_low, -whole_high), 0.0);
  if (dot(closest_xz, closest_xz) > layer.expected.z * layer.expected.z) return;
  uint map = occlusion_map_of(velocity);
  vec3 fall = occlusion.fall_texel[map].xyz;
  bool same_fall = dot(fall, velocity) > 0.9999 * length(velocity);
  float life = splash_life(diameter) + frame.camera_velocity_mps.w;
  float reached = layer.expected.z;  // m
  bool droplets_here = reach.w > 0.0 && diameter > 1e-3;
  float near_life = max(life, SECONDARY_LIFE + frame.camera_velocity_mps.w);

  uint mask[4] = uint[](0u, 0u, 0u, 0u);  // an array: a vector written by a variable index hung an NVIDIA GPU
  float highest = -1e30, lowest = 1e30, nearest = 1e30, deepest_life = 0.0;
  for (int s = 0; s < across * along; ++s) {
    vec2 q = low + (vec2(s % across, s / across) + 0.5) * (high - low) / vec2(across, along);
    vec3 place = vec3(q.x, base, q.y);
    // Down to the surface along the class's own fall: the map's may differ a little, so twice.
    float hit = occlusion_first_hit_m(map, place);
    if (abs(hit) > 1e5) continue;
    float y = base + fall.y * hit;
    place = vec3(q.x + slope.x * (y - base), y, q.y + slope.y * (y - base));
    hit = same_fall ? 1e6 : occlusion_first_hit_m(map, place);
    if (abs(hit) < 1e5) {
      y += fall.y * hit;
      place = vec3(q.x + slope.x * (y - base), y, q.y + slope.y * (y - base));
    }
    float away = length(place);
    if (away > reached + edge) continue;
    float oldest = droplets_here && away < reach.y + edge ? near_life : life;
    highest = max(highest, y);
    lowest = min(lowest, y);
    nearest = min(nearest, away);
    deepest_life = max(deepest_life, oldest);
    int first = int(floor((y - 0.15 - speed * oldest - base) / edge)), last = int(floor((y + 0.15 - base) / edge));
    for (int level = max(first, 0); level <= min(last, levels - 1); ++level) mask[level >> 5] |= 1u << uint(level & 31);
  }
  if (nearest > 1e29) return;

  // Lamps: the tile's, where the ground is about as high as the tile's was.
  vec3 middle = vec3(corner.x + 0.5 * edge, 0.5 * (highest + lowest), corner.y + 0.5 * edge);
  middle.xz += slope * (middle.y - base);
  ivec2 t = ivec2(floor((middle.xz - tiling.xy) / tiling.z));
  SplashTileGpu tile;
  tile.light.z = -1e9;
  if (all(greaterThanEqual(t, ivec2(0))) && all(lessThan(t, ivec2(SPLASH_TILES)))) tile = tiles[t.y * SPLASH_TILES + t.x];
  uvec4 pairs = tile.lights;
  int light_count = int(tile.light.x);
  float brightness = tile.light.y;
  if (abs(tile.light.z - middle.y) > 1.0) {
    light_count = lights_of_cell(middle, 0.71 * edge + 0.02, pairs);
    brightness = brightness_at(middle, pairs, light_count);
  }
  float at_a_metre = importance_of(diameter, speed, 1.0, brightness);
  bool any_cell = false;
  for (int word = 0; word < 4; ++word) {
    for (uint bits = mask[word]; bits != 0u; bits &= bits - 1u) {
      int bit = findLSB(bits);
      int level = 32 * word + bit;
      ivec2 moved = column + lean(layer, level);
      ivec3 cell = ivec3(moved.x, level, moved.y);
      vec3 at = layer.corner_edge.xyz + vec3(cell) * edge;
      // Where its drops landed: back along their way.
      vec3 back = -velocity * deepest_life;
      vec3 box_low = at + min(back, 0.0) - 0.03, box_high = at + edge + max(back, 0.0) + 0.03;
      box_low.y = max(box_low.y, lowest - 0.2);
      box_high.y = min(box_high.y, highest + 0.2);
      if (box_low.y > box_high.y || !touches(0.5 * (box_low + box_high), 0.5 * (box_high - box_low))) continue;
      vec3 closest = max(max(box_low, -box_high), 0.0);
      if (dot(closest, closest) > reached * reached) continue;
      uvec3 key;
      uint count = drops_of_cell(layer, uvec3(cell), key);
      any_cell = true;
      if (count == 0u) continue;
      uint slot = atomicAdd(command.cell_groups.w, 1u);
      if (slot >= cell_capacity) continue;
      const uint per_row = uint(SPLASH_ROW * (SPLASH_GROUP / SPLASH_CELL_LANES));
      if (slot % per_row == 0u) atomicMax(command.cell_groups.y, slot / per_row + 1u);
      cells[slot].corner_edge = vec4(at, edge);
      cells[slot].key = uvec4(key, count << 16u | uint(light_count) << 12u | l);
      cells[slot].lights = pairs;
      cells[slot].slab = vec4(highest + 0.15, lowest - 0.15, at_a_metre, deepest_life);
    }
  }
  if (!any_cell) return;
  // All that lands in the column's own width while a splash lives; parts outside the view count too.
  float crowns = min(deepest_life, life);
  float per_s = 256.0 * layer.expected.w * edge * edge * speed;
  float importance = at_a_metre / max(nearest * nearest, 0.09);
  int bin = bin_of(importance);
  uint units = uint(per_s * crowns + 0.5);
  if (units > 0u) atomicAdd(command.expected[bin >> 2][bin & 3], units);
  // Droplets that outlive them.
  bin = bin_of(DROPLETS_WEIGH * importance);
  units = uint(per_s * (deepest_life - crowns) + 0.5);
  if (units > 0u) atomicAdd(command.expected[bin >> 2][bin & 3], units);
}
