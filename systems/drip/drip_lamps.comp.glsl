#version 450 core
// Which lamps light the clusters of drips.
layout(local_size_x = 64) in;
#include "systems/drip/drip_shared.h"
#include "systems/drops/cell_lights.glsl"

layout(std430, binding = DRIP_CLUSTERS_BINDING) readonly buffer DripClusters { vec4 clusters[]; };  // centre, radius
layout(std430, binding = DRIP_LAMPS_BINDING) writeonly buffer DripLamps { DripLampsGpu lamps_of[]; };
uniform uint cluster_count;

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= cluster_count) return;
  uvec4 indices;
  int count = lights_of_cell(clusters[index].xyz, clusters[index].w, indices);
  lamps_of[index].lights = indices;
  lamps_of[index].count = uvec4(uint(count), 0u, 0u, 0u);
}
