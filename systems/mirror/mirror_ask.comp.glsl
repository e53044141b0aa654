#version 450 core
// What mirrors, probes and the shared surroundings say about places and directions: for charts and tests.
#include "systems/frame.glsl"
#include "systems/lighting/environment.glsl"
#include "systems/mirror/mirror.glsl"
#include "systems/mirror/probe.glsl"

layout(local_size_x = 64) in;
struct Question {
  vec4 place_roughness;  // relative to the camera
  vec4 normal;
  vec4 direction;
};
struct Answer {
  vec4 mirror, probe, endless_probe, environment;  // endless: as if all it saw were endlessly far
};
layout(std430, binding = 7) readonly buffer Questions { Question questions[]; };
layout(std430, binding = 8) writeonly buffer Answers { Answer answers[]; };
uniform uint count;
uniform bool has_mirrors, has_probes, has_environment;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  Question q = questions[i];
  vec3 place = q.place_roughness.xyz;
  float roughness = q.place_roughness.w;
  Answer a = Answer(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  if (has_mirrors) a.mirror = mirror_radiance(place, q.normal.xyz, roughness, q.direction.xyz);
  if (has_probes) {
    a.probe = probe_radiance(place, q.direction.xyz, roughness);
    int nearest = 0;
    for (int k = 1; k < int(probes.counts.x); ++k)
      if (length(place - probes.place_radius[k].xyz) < length(place - probes.place_radius[nearest].xyz)) nearest = k;
    float level = clamp(roughness, 0.0, 1.0) * float(ENVIRONMENT_LEVELS - 1);
    a.endless_probe = mix(probe_tile(nearest, q.direction.xyz, floor(level)),
                          probe_tile(nearest, q.direction.xyz, min(floor(level) + 1.0, float(ENVIRONMENT_LEVELS - 1))),
                          fract(level));
  }
  if (has_environment) a.environment = vec4(environment_radiance(q.direction.xyz, roughness), 1.0);
  answers[i] = a;
}
