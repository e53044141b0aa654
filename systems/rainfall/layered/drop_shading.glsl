// What a single drop of the layered composite shows, and what the artist does to it.
#ifndef SYSTEMS_RAINFALL_LAYERED_DROP_SHADING_GLSL
#define SYSTEMS_RAINFALL_LAYERED_DROP_SHADING_GLSL

layout(binding = 3) uniform sampler2DArray drop_normals;  // xy: normal in the picture's plane, z: share of the drop
uniform float strength;   // of the rain
uniform float lightning;  // l_b = 1 + k_c (L_1 + L_2)
uniform float milk;

// The lightning's bias acts on opacity, and on reflection, refraction and specular light alike.
float artist_opacity(float opacity) { return clamp(opacity * strength * lightning, 0.0, 1.0); }
// light: what drops of this opacity send, output units; milk shines with what the picture shows as white.
vec3 artist_light(vec3 light, float opacity) { return mix(light * lightning, vec3(opacity), milk); }

#ifdef PUBLISHED
// "a variation of the Fresnel equations"
float drop_fresnel(float cosine) {
  float c = 1.0 - cosine;
  return 0.95 * c * c * c * c + 0.05;
}
#else
// Exact, air to water, unpolarised.
float drop_fresnel(float c) {
  float s = sqrt(1.0 - (1.0 - c * c) * 0.5627815);
  float rs = (c - 1.333 * s) / (c + 1.333 * s), rp = (1.333 * c - s) / (1.333 * c + s);
  return 0.5 * (rs * rs + rp * rp);
}
#endif

#ifdef NORMALS
// What ambient.glsl says of a drop that is not resolved.
vec3 drop_means(vec3 ray) { return 0.93 * environment_radiance(ray, 0.55) + 0.0664 * environment_mean(); }

// Radiance of a drop's image at a place across it (-1 to 1), refracted and reflected, cd/m2. Its shape is a layer of the
// normal map; a drop that moves by many diameters while the shutter is open is blurred along: a bias of the level of
// detail, as is the size of its image.
vec3 drop_shows(vec3 ray, vec3 way, float across_drop, uint kind, float width_px, float elongation) {
  vec3 right = normalize(cross(ray, way)), up = cross(right, ray);
  float size = float(textureSize(drop_normals, 0).x);
  float level = max(log2(size / width_px), 0.0) + 0.15 * log2(max(elongation, 1.0));
  vec2 at = vec2(0.5 + 0.5 * across_drop, 0.5);
  vec3 texel = textureLod(drop_normals, vec3(at, float(kind % uint(LAYERED_SHAPES))), level).xyz;
  vec2 xy = texel.xy / max(texel.z, 0.1);
  vec3 normal = normalize(right * xy.x + up * xy.y - ray * sqrt(max(1.0 - dot(xy, xy), 0.0025)));
  float cosine = clamp(-dot(ray, normal), 0.0, 1.0);
  float reflected = drop_fresnel(cosine);
  // Through the sphere: twice the turn at its surface.
  vec3 within = refract(ray, normal, 1.0 / 1.333);
  vec3 out_ray = normalize(2.0 * dot(within, ray) * within - ray);
  return reflected * environment_radiance(reflect(ray, normal), 0.3) +
         (1.0 - reflected) * environment_radiance(out_ray, 0.2);
}
#endif

#endif
