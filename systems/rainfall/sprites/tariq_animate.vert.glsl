#version 450 core
// Tariq 2007, code listings 1 and 2, for the benchmark: particles move in the vertex shader and are streamed out.
layout(location = 0) in vec4 place_diameter;   // relative to the camera, m; m
layout(location = 1) in vec4 velocity_random;  // m/s; 0 to 1
layout(location = 2) in vec3 seed_place;       // where it is spawned again

layout(xfb_buffer = 0, xfb_stride = 32) out;
layout(xfb_offset = 0) out vec4 moved_place_diameter;
layout(xfb_offset = 16) out vec4 moved_velocity_random;

uniform float step_s;
uniform float fall_m;  // below its seed it is out of bounds

void main() {
  vec3 place = place_diameter.xyz + velocity_random.xyz * step_s;
  if (place.y < seed_place.y - fall_m) place = seed_place;
  moved_place_diameter = vec4(place, place_diameter.w);
  moved_velocity_random = velocity_random;
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
