#version 450 core
// Where the particles of the box are now, and a list of those that the view sees (Tariq 2007, "Animating Rain"; by
// compute, where he had stream out).
//
// By default a particle has no state: its place is where it began plus how far its class has fallen and drifted,
// wrapped in the box about the camera. What leaves below comes in above with the size it had, so sizes arrive as they
// fall, by v N(D), and the box keeps N(D). PUBLISHED keeps places and velocities, integrates them frame by frame by
// Euler's rule, and spawns whatever left the box at its top, with a size by N(D).
#include "systems/rainfall/sprites/sprites_shared.h"
layout(local_size_x = SPRITE_GROUP) in;
#include "systems/rainfall/streak.glsl"

layout(std430, binding = SPRITES_BINDING) writeonly buffer Sprites { SpriteGpu sprites[]; };
layout(std430, binding = SPRITE_CLASSES_BINDING) readonly buffer SpriteClasses { SpriteClassGpu classes[]; };
layout(std430, binding = RAIN_COMMAND_BINDING) buffer RainCommand {
  uint groups_x, groups_y, groups_z;  // of the drawing's indirect dispatch
  uint sprite_count;
  uint drops_drawn;
};
uniform uint class_count, particles, capacity;
uniform float box_m;

struct Particle {
  vec3 place;  // relative to the camera, m
  vec3 velocity;
  float diameter;
  uint bits;
};

#ifdef PUBLISHED
layout(std430, binding = SPRITE_STATES_BINDING) buffer SpriteStates { SpriteStateGpu states[]; };
uniform uint known;     // of the particles, from the frames before; the others are new
uniform uint shown;     // particles that are drawn of those that are animated
uniform float step_s;   // 0: frozen
uniform vec3 wind_mps;

uint class_by_density(uint random) {
  int share = int(random >> 8u);
  uint k = 0u;
  while (k + 1u < class_count && classes[k].numbers.w <= share) ++k;
  return k;
}

Particle particle_at(uint i) {
  vec3 eye = frame.camera_world_m.xyz;
  bool fresh = i >= known;
  SpriteStateGpu state = states[i];
  vec3 place = uintBitsToFloat(state.place_class.xyz), velocity = uintBitsToFloat(state.velocity_generation.xyz);
  uint k = fresh ? 0u : state.place_class.w, generation = state.velocity_generation.w;
  if (fresh) {
    generation = 0u;
  } else if (step_s > 0.0) {
    // dv/dt = g - (g / V^2) |u| u, u the velocity in the air (physics, section 1), by Euler: diverges where the step
    // is longer than V / g.
    float terminal = classes[k].origin_speed.w;
    vec3 u = velocity - wind_mps;
    velocity += step_s * (vec3(0.0, -9.81, 0.0) - 9.81 / (terminal * terminal) * length(u) * u);
    place += step_s * velocity;
  }
  bool inside = all(lessThanEqual(abs(place - eye), vec3(0.5 * box_m)));  // false for what is no number, too
  if (fresh || !inside) {
    generation += 1u;
    uvec4 b = random_bits4(uvec4(i, generation, seed, 0x7a21u));
    k = class_by_density(b.w);
    vec3 corner = vec3(unit_float(b.x), fresh ? unit_float(b.y) : 1.0, unit_float(b.z)) - 0.5;
    place = eye + box_m * corner;
    velocity = vec3(0.0, -classes[k].origin_speed.w, 0.0);
  }
  states[i].place_class = uvec4(floatBitsToUint(place), k);
  states[i].velocity_generation = uvec4(floatBitsToUint(velocity), generation);
  return Particle(place - eye, velocity, classes[k].velocity_diameter.w, random_bits(uvec4(i, generation, seed, 1u)));
}
#else
Particle particle_at(uint i) {
  uint low = 0u, high = class_count - 1u;
  while (low < high) {
    uint middle = (low + high + 1u) / 2u;
    if (uint(classes[middle].numbers.y) <= i) low = middle; else high = middle - 1u;
  }
  SpriteClassGpu c = classes[low];
  uint number = i - uint(c.numbers.y), salt = uint(c.numbers.z) ^ (seed * 0x9e3779b9u);
  float up = unit_float(random_bits(uvec4(number, salt, 0x5bd1u, 7u))) + c.origin_speed.y;
  // Each time it enters anew it does so elsewhere, or the rain would repeat itself.
  uint turn = uint(c.numbers.x) + (up >= 1.0 ? 1u : 0u);
  uvec4 b = random_bits4(uvec4(number, salt, turn, 11u));
  vec3 place = vec3(unit_float(b.x) + c.origin_speed.x, up, unit_float(b.z) + c.origin_speed.z);
  place -= step(1.0, place) + 0.5;
  return Particle(box_m * place, c.velocity_diameter.xyz, c.velocity_diameter.w, b.y ^ b.w);
}
#endif

bool seen_particle(uint i, out SpriteGpu sprite) {
  if (i >= particles) return false;
  Particle p = particle_at(i);
  sprite.place_diameter = vec4(p.place, p.diameter);
  sprite.velocity_bits = uvec4(floatBitsToUint(p.velocity), p.bits);
#ifdef PUBLISHED
  if (i >= shown) return false;
#endif
  Streak s;
  return project(p.place, float(p.bits & 0xffffu) / 65536.0, 1.0, p.velocity, p.diameter, s);
}

shared uint group_sprites, group_first;

void main() {
  uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * uint(SPRITE_GROUP) + gl_LocalInvocationID.x;
  if (gl_LocalInvocationIndex == 0u) group_sprites = 0u;
  barrier();
  SpriteGpu sprite;
  bool seen = seen_particle(index, sprite);
  uint slot = 0u;
  if (seen) slot = atomicAdd(group_sprites, 1u);
  barrier();
  if (gl_LocalInvocationIndex == 0u && group_sprites > 0u) {
    group_first = atomicAdd(sprite_count, group_sprites);
    const uint per_row = uint(RAIN_COMMAND_WIDTH * SPRITE_GROUP);
    uint last = min(group_first + group_sprites, capacity) - 1u;
    if (group_first < capacity && (group_first % per_row == 0u || last / per_row != group_first / per_row))
      atomicMax(groups_y, last / per_row + 1u);
  }
  barrier();
  if (seen && group_first + slot < capacity) sprites[group_first + slot] = sprite;
}
