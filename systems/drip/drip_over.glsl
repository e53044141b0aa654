// What the vertices of a drip's quad hand on to its pixels.
#ifndef SYSTEMS_DRIP_OVER_GLSL
#define SYSTEMS_DRIP_OVER_GLSL
#ifndef DRIP_STAGE
#error "in or out"
#endif
layout(location = 0) flat DRIP_STAGE vec4 from_to;      // pixels
layout(location = 1) flat DRIP_STAGE vec4 depths_kept;  // of the depth buffer; z: radius, pixels; w: share of the time
layout(location = 2) flat DRIP_STAGE vec3 ray;          // unit, to the drop
layout(location = 3) flat DRIP_STAGE uvec2 which;       // source; 1: a billboard
layout(location = 4) flat DRIP_STAGE vec3 even_light;   // of lamps, over the whole disc, cd/m2
layout(location = 5) flat DRIP_STAGE vec3 glint_light;  // of the lamp that glints most
layout(location = 6) flat DRIP_STAGE vec2 glint_place;  // in the disc, in radii
layout(location = 7) flat DRIP_STAGE vec2 away_tall;    // m; height over width of a drop that hangs, or 1
#endif
