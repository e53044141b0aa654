#version 450 core
// Asks the maps about places (OcclusionStage).
layout(local_size_x = 64) in;
#include "systems/occlusion/occlusion.glsl"

struct Question {
  vec4 place;     // relative to the camera
  vec4 normal;
  vec4 velocity;
};
layout(std430, binding = 7) readonly buffer Questions { Question questions[]; };
layout(std430, binding = 8) writeonly buffer Answers { vec4 answers[]; };  // two each
uniform uint count;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  vec3 place = questions[i].place.xyz, normal = questions[i].normal.xyz, velocity = questions[i].velocity.xyz;
  answers[2u * i] = vec4(first_hit_distance_m(place), sheltered(place) ? 1.0 : 0.0, sheltered(place, velocity) ? 1.0 : 0.0,
                         shelter(place));
  answers[2u * i + 1u] = vec4(shelter(place, normal), deposit(place, normal), first_hit_distance_m(place, velocity),
                              float(occlusion.counts.z));
}
