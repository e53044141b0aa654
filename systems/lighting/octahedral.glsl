// Octahedral maps over the whole sphere with a border: direction <-> texel of a square tile. The mapping itself
// is gbuffer.glsl's (Cigolle et al. 2014), repeated for shaders that read no G-buffer.
#ifndef SYSTEMS_LIGHTING_OCTAHEDRAL_GLSL
#define SYSTEMS_LIGHTING_OCTAHEDRAL_GLSL

vec2 square_from_direction(vec3 d) {  // to [0,1]^2; d need not be unit
  vec2 p = d.xz / (abs(d.x) + abs(d.y) + abs(d.z));
  vec2 s = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  return (d.y >= 0.0 ? p : (1.0 - abs(p.yx)) * s) * 0.5 + 0.5;
}

// From a square that may be left by less than its size: the map continues mirrored across its edges.
vec3 direction_from_square(vec2 square) {
  vec2 p = square * 2.0 - 1.0;
  if (abs(p.x) > 1.0) p = vec2((p.x > 0.0 ? 2.0 : -2.0) - p.x, -p.y);
  if (abs(p.y) > 1.0) p = vec2(-p.x, (p.y > 0.0 ? 2.0 : -2.0) - p.y);
  float y = 1.0 - abs(p.x) - abs(p.y);
  float t = max(-y, 0.0);
  return normalize(vec3(p.x + (p.x >= 0.0 ? -t : t), y, p.y + (p.y >= 0.0 ? -t : t)));
}

// Six faces of a cube, +x -x +y -y +z -z, each the picture of a right-handed camera with a field of view of 90
// degrees (systems/lighting/cube_faces.hpp). Returns xy in [0,1]^2 and the face in z.
vec3 face_from_direction(vec3 d) {
  vec3 a = abs(d);
  float face, m;
  vec2 p;
  if (a.x >= a.y && a.x >= a.z) {
    face = d.x > 0.0 ? 0.0 : 1.0; m = a.x; p = vec2(d.x > 0.0 ? d.z : -d.z, d.y);
  } else if (a.y >= a.z) {
    face = d.y > 0.0 ? 2.0 : 3.0; m = a.y; p = vec2(d.y > 0.0 ? d.x : -d.x, d.z);
  } else {
    face = d.z > 0.0 ? 4.0 : 5.0; m = a.z; p = vec2(d.z > 0.0 ? -d.x : d.x, d.y);
  }
  return vec3(p / m * 0.5 + 0.5, face);
}

// The direction, 1 along the face's axis. p in [-1,1]^2.
vec3 direction_of_face(vec2 p, int face) {
  if (face == 0) return vec3(1.0, p.y, p.x);
  if (face == 1) return vec3(-1.0, p.y, -p.x);
  if (face == 2) return vec3(p.x, 1.0, p.y);
  if (face == 3) return vec3(-p.x, -1.0, p.y);
  if (face == 4) return vec3(-p.x, p.y, 1.0);
  return vec3(p.x, p.y, -1.0);
}

#endif
