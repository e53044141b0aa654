#version 450 core
layout(location = 0) in vec3 vertex_normal;
layout(location = 0) out vec4 out_normal;

void main() {
  vec3 n = normalize(vertex_normal);
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  vec2 s = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  out_normal = vec4((n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * s) * 0.5 + 0.5, 0.2, 1.0);
}
