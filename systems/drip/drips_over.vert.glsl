#version 450 core
// A quad about the way of each drip that is drawn as a picture of a drop: billboards, and drops that show the world.
#define DRIP_STAGE out
#include "systems/drip/drip_over.glsl"
#include "systems/drip/drip_streak.glsl"
#include "systems/drip/drip_optics.glsl"

layout(std430, binding = DRIP_LOOKS_BINDING) readonly buffer DripLooks { DripLooksGpu looks[]; };
uniform uint first_drip;
uniform float reach_m;

void main() {
  DripGpu drip = drips[first_drip + uint(gl_InstanceID)];
  Streak s;
  gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
  from_to = vec4(0.0);
  depths_kept = vec4(0.0);
  ray = vec3(0.0, 0.0, -1.0);
  which = drip.bits.zw;
  even_light = glint_light = vec3(0.0);
  glint_place = vec2(0.0);
  away_tall = vec2(1.0);
  if (!project_drip(drip, s)) return;
  float away = length(s.middle), tall = hangs(drip) ? drip.velocity_stretch.w : 1.0;
  away_tall = vec2(away, tall);
  ray = s.middle / away;
  vec2 along = s.to - s.from;
  float len = length(along);
  along = len > 1e-3 ? along / len : vec2(0.0, -1.0);
  float r = max(s.radius, 0.5);  // at least a pixel wide
  float kept = s.area / (3.14159265 * r * r * tall);
  if (drip.bits.w == 1u) {
    // Stochastic elongation by motion, driven by depth and velocity (section 3.2): the way that it falls while the
    // shutter is open, times its own factor, less for far ones.
    DripLooksGpu look = looks[drip.bits.z];
    bool published = look.published.x > 0.5;
    float chance = float(drip.bits.x >> 8u) * 5.9604644775390625e-8;
    float factor = (0.5 + chance) * look.opacity.w;
    if (published) factor *= 1.0 - 0.5 * min(away / reach_m, 1.0);
    vec2 middle = 0.5 * (s.from + s.to);
    len *= factor;
    s.from = middle - 0.5 * len * along;
    s.to = middle + 0.5 * len * along;
    // The disc's picture is stretched over the whole way: an ellipse, so opaque that the drop's mean is kept; as printed
    // it is as opaque as it is.
    kept = published ? 1.0 : s.area / (3.14159265 * r * (r * tall + 0.5 * len));
  }
  from_to = vec4(s.from, s.to);
  depths_kept = vec4(s.depths, r, kept);
#ifdef LAMPS
  DripLampsGpu here = lamps_of[drip.bits.y];
  vec3 towards_lamp = vec3(0.0, 1.0, 0.0);
  float most = 0.0;
  for (int i = 0; i < RAIN_CELL_LIGHTS; ++i) {
    if (i >= int(here.count.x)) break;
    LightGpu light = lamp_of(here, i);
    vec3 given = lamp_light(light, s.middle, away);
    float bright = max(given.r, max(given.g, given.b));
    even_light += given;
    if (bright > most) {
      most = bright;
      glint_light = given;
      bool directional = light.direction_kind.w == float(LIGHT_DIRECTIONAL);
      towards_lamp = directional ? -light.direction_kind.xyz : normalize(light.position_range.xyz - s.middle);
    }
  }
  even_light -= glint_light;
  float seen = exp(-(frame.mist.x + frame.rain.z) * away);
  even_light *= seen;
  glint_light *= seen;
  // The lamp's image stands on the line from the disc's centre towards where the lamp is, or away from there.
  vec3 right = vec3(frame.view[0][0], frame.view[1][0], frame.view[2][0]);
  vec3 up = vec3(frame.view[0][1], frame.view[1][1], frame.view[2][1]);
  vec2 side = vec2(dot(towards_lamp, right), dot(towards_lamp, up));
  float turn = acos(clamp(dot(towards_lamp, ray), -1.0, 1.0));
  glint_place = side / max(length(side), 1e-4) * clamp(glint_at(turn), -0.82, 0.82);
  if (most > 0.0 && drip.bits.w == 0u) glint_light /= glint_mean(length(glint_place), r);
#endif
  // Two triangles about the way.
  vec2 corner = vec2(float(gl_VertexID & 1) * 2.0 - 1.0, float(gl_VertexID >> 1) * 2.0 - 1.0);
  vec2 across = vec2(-along.y, along.x);
  vec2 pixel = 0.5 * (s.from + s.to) + across * (corner.x * (r + 1.0)) + along * (corner.y * (0.5 * len + r * tall + 1.0));
  gl_Position = vec4(pixel * frame.size.zw * 2.0 - 1.0, 0.0, 1.0);
}
