#version 450 core
// The mist on a fin: falls off with height, and carries the rainfall's scrolled texture (section 3.1) in the mist's own
// speeds: droplets that rise and droplets that fall.
#include "systems/geometry/position.glsl"
#include "systems/splatter/catcher.glsl"
layout(binding = 0) uniform sampler2D scene_depth;
layout(binding = 3) uniform sampler2D mist_texture;
layout(location = 0) in vec3 fin_place;
layout(location = 1) in vec2 fin_coordinate;
layout(location = 2) in float fin_depth;
layout(location = 3) in vec3 fin_lamps;
layout(location = 0) out vec4 out_colour;
uniform vec2 scrolled;    // metres that the rising and the falling texture have moved, wrapped at a tile
uniform float tile_m;
uniform float length_m;   // as printed; 0: mended

// Mean 1; deviation as the number of droplets in a texel's column has it.
float droplets(vec2 at) {
  // (x_i, y_i) = v_r |v_r| dt, and w_i = p_r r_i as the divisor of a projective fetch: two layers of other depth and speed.
  float rising = textureProj(mist_texture, vec3((at + vec2(0.0, -scrolled.x)) / tile_m, 1.0)).r;
  float falling = textureProj(mist_texture, vec3(vec2(at.x + 0.37 * tile_m, at.y + scrolled.y) / tile_m, 1.31)).g;
  return rising + falling - 1.0;  // each has mean 0.5: deviation about 0
}

void main() {
  float texel = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
  float fin_m = frame.camera_world_m.w / gl_FragCoord.z;
  float behind_m = frame.camera_world_m.w / max(texel, 1e-7) - fin_m;  // axial metres from the fin to the scene
  float depth;
  if (length_m > 0.0) {
    if (behind_m < 0.0) discard;
    // "The rainfall algorithm from section 3.1 as an animated texture, alpha-blended": its own opacity, layer over layer.
    float near = textureProj(mist_texture, vec3((fin_coordinate + vec2(0.0, -scrolled.x)) / tile_m, 1.0)).r;
    float far = textureProj(mist_texture, vec3((fin_coordinate + vec2(0.37 * tile_m, scrolled.y)) / tile_m, 1.31)).g;
    float alpha = clamp(near * far * fin_depth * max(1.0 - fin_coordinate.y / length_m, 0.0), 0.0, 0.99);
    depth = -log(1.0 - alpha);
  } else {
    // Soft where the scene cuts it: over the thickness of the mist.
    float soft = clamp(behind_m / catcher.mist.y + 0.5, 0.0, 1.0);
    depth = fin_depth * exp(-max(fin_coordinate.y, 0.0) / catcher.mist.y) * soft;
    depth *= 1.0 - smoothstep(3.0, 4.0, fin_coordinate.y / catcher.mist.y);
    // Droplets in the column of a pixel, or of a texel of the texture where that is larger.
    float pixel_m = max(length(fin_place) / frame.lens.z, tile_m / 256.0);
    float number = depth * pixel_m * pixel_m / (0.785 * catcher.mist.z * catcher.mist.z);
    depth *= max(1.0 + droplets(fin_coordinate) * min(4.0 * inversesqrt(max(number, 1e-4)), 1.6), 0.0);
  }
  depth = max(depth, 0.0);
  float opacity = 1.0 - exp(-depth);
  vec3 light = (drop_ambient(normalize(fin_place)) + fin_lamps) * opacity;
  out_colour = vec4(min(light, vec3(60000.0)), opacity);
}
