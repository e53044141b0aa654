#pragma once
// Where water gathers, runs off, stands and splashes. Each struct says which system reads it.
#include <cstdint>
#include <glm/glm.hpp>

namespace petrichor {

// An edge that water drips from: a line of length_m along the entity's +x (shared physics, section 8). Rain on the
// catchment runs to the edge with a delay, gathers in pendant drops, and these let go at their physical size.
struct DripSource {
  float length_m = 1.0f;
  float catchment_depth_m = 0.3f;  // roof or ledge behind the edge, measured along the fall of water
  float lip_radius_mm = 2.0f;
  float edge_share = 1.0f;        // of the catchment's water; the rest goes down a pipe (a gutter leaks little)
  float runoff_s = 25.0f;         // time constant of the water on the catchment: it drips on after the rain
  float site_spacing_mm = 24.3f;  // from drop to drop: 2 pi sqrt(2) capillary lengths under an even edge
  float site_scatter = 0.4f;      // of the spacing, how unevenly they hang
  float jitter = 0.15f;           // of the time from one drop of a site to the next, either way
  float wind = 1.0f;              // multiplies the wind on its drops
  float elongation = 1.0f;        // of billboards: multiplies how motion stretches them; 1: as far as they fall
  float opacity = 1.0f;           // of billboards, alpha; edge_strength and edge_bias are e_s and e_b of
  float edge_strength = 0.5f;     //   Tatarchuk and Isidoro 2006, section 3.2: alpha (e_s f + e_b)
  float edge_bias = 0.95f;
  bool published = false;  // billboards: opacity by distance and lightning as printed, whatever that does to the mean
};

// How the wet area of a hollow grows with the depth of its water.
enum class PuddleShape { bowl, tub };  // in proportion; upright sides

// A hollow where water stands: a rectangle in the entity's x and z, which lies at the hollow's brim. How deep each place
// in it is, a mask of the material says (systems/wet_materials.hpp), or the ground's own height below the brim.
struct Puddle {
  glm::vec2 size_m{1.0f, 1.0f};
  float maximum_depth_mm = 12.0f;
  float area_share = 0.7f;       // wet area when full, of the rectangle
  float catchment_ratio = 3.0f;  // area whose rain comes here, over the wet area when full
  PuddleShape shape = PuddleShape::bowl;
  float mean_depth_share = 0.4f;   // of a bowl: its mean depth over its greatest; 1/2 a paraboloid, 1/3 a cone
  bool by_height = false;  // depth from the ground's height instead of from a mask
  float drain_mm_per_hour = 2.0f;         // through the bottom
  float evaporation_mm_per_hour = 0.1f;   // after rain: 12 C and 60 % humidity; while it rains, none
  float initial_fill = -1.0f;    // share of the depth; -1: what the rain at the beginning brings in history_min
  float history_min = 20.0f;
  float time_scale = 1.0f;       // how fast it fills and dries; 1 is true
  float ripple_influence = 1.0f;  // p_i, s_o and theta_o of Tatarchuk and Isidoro (2006), section 4; with the material's
  float ripple_scale = 1.0f;
  float ripple_turn_deg = 0.0f;
};

// How surfaces take up water and dry, on the emitter's entity. Every emitter gets one, with these defaults, when a scene
// is opened.
struct WetGround {
  float initial_wetness = -1.0f;  // 0 dry, 1 as after long rain of the first tick's rate (10 mm/h without one); -1: 1
                                  // where it rains at the start, else 0
  float drying_speed = 1.0f;      // while no rain falls, water runs off and dries so many times faster; 1 is true
  float humidity = 0.75f;         // relative, once the rain has stopped; while it falls the air is full
  float temperature_c = 14.0f;    // of air and ground
  bool published = false;         // of wetness=everywhere: Lagarde's factors as printed, instead of the film model
};

// Rings on the water that stands, on the emitter's entity. Every emitter gets one, with these defaults, when a scene is
// opened. (Tatarchuk and Isidoro 2006, section 4; s_o, theta_o and the influence p_i are the puddles' materials'.)
struct Ripples {
  bool published = false;          // as printed: dampened sines by drops' mass, 16 bits; their level drifts
  float strength = 1.0f;           // multiplies all slopes; 1 is true
  float wave_speed_mps = 0.235f;   // of all waves on the lattice: closest to what real ones of a drop do together
  float decay_per_s = 1.8f;        // of their heights
  float tile_m = 0.75f;            // edge of the tile that all puddles share; 256 cells of it fit real rings
  float seed_cells = 3.0f;         // least deviation of a ring's seed, in cells of the lattice; narrower ones break up
};

// Something that moves through standing water and leaves a wake: a disc about the entity's place.
struct Wader {
  float radius_m = 0.15f;
  float draft_mm = 6.0f;   // of the water that it pushes before it
  float height_m = 0.4f;   // its place may be so far above or below the water
};

// Settings of the splashes of the rain (Tatarchuk and Isidoro 2006, section 3.3), on the emitter's entity. Every emitter
// gets them, with these defaults, when a scene is opened.
struct Splashes {
  float reach_m = 20.0f;               // single splashes out to here
  float secondary_reach_m = 3.0f;      // with their droplets out to here
  std::int32_t most_splashes = 20000;  // alive at once, on average; the less important are thinned out
  float size = 1.0f, size_variation = 0.25f;        // multiplies the crowns; either way, at random
  float opacity = 1.0f, opacity_variation = 0.3f;   // likewise
  float edge_strength = 0.8f, edge_bias = 0.55f;    // e_s and e_b of section 3.2
  float backlight = 1.0f;              // multiplies the light of lamps; 1 is true
  bool published = false;              // of splashes=random: as printed
};

// A glass surface that droplets sit on and run down: a rectangle in the entity's x and y.
struct GlassPane {
  glm::vec2 size_m{1.0f, 1.0f};
  float advancing_angle_deg = 60.0f;
  float receding_angle_deg = 30.0f;
};

// Rain strikes this and what is below it in the tree: rings of splatter on it, and mist of splashes along its outline
// (Tatarchuk and Isidoro 2006, section 3.4). Drawn where the rain reaches it; cars and posts, moving or not.
struct RainCatcher {
  float splatter = 1.0f;      // multiplies the rings' opacity; 1 is true
  std::int32_t shells = 6;    // layers that a crown is cut into
  float shell_height_mm = 6.0f;  // of the highest one
  float halo = 1.0f;          // multiplies the mist's density; 1 is true
  float halo_height = 1.0f;   // multiplies its height; 1 is true
  bool published = false;     // as printed: extruded shells, hard silhouettes, an artist's opacity
};

}  // namespace petrichor
