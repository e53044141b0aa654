#version 450 core
layout(location = 0) in vec4 place_diameter;
layout(location = 1) in vec4 velocity_random;
out vec4 drop_place_diameter;
out vec4 drop_velocity_random;

void main() {
  drop_place_diameter = place_diameter;
  drop_velocity_random = velocity_random;
}
