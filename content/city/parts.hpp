#pragma once
// The parts of the town. Each adds meshes, nodes, lights and marked components to the scene.

#include <string>

#include "content/city/builder.hpp"
#include "content/city/scene.hpp"
#include "content/city/standing_water.hpp"

namespace petrichor::city {

// Helpers shared by the parts (parts.cpp).
int add_node(Scene&, const std::string& name, int parent, int mesh, const glm::mat4& frame = glm::mat4(1.0f));
int add_mesh_node(Scene&, int parent, Mesh, const glm::mat4& frame = glm::mat4(1.0f));  // a node named as its mesh
// A light at a place; a spot shines along `direction`. Returns the node.
struct Lamp {
  glm::vec3 colour{1.0f};
  float intensity_cd = 300.0f;
  float range_m = 25.0f;
  float inner_deg = 0.0f, outer_deg = 0.0f;  // half angles; outer 0 means a point light
  bool casts_shadow = false;
  float source_radius_m = 0.08f;
};
int add_light(Scene&, const std::string& name, int parent, glm::vec3 position, const Lamp&,
              glm::vec3 direction = {0, -1, 0});
// Marks: a line along the frame's x, or a rectangle in its x and y (pane) or x and z (puddle), centred.
struct DripMark {
  float edge_share = 1.0f;  // of the catchment's water: gutters leak little
  int sites = 0;            // evenly spaced, as the tips of a valance are; 0: as under an even edge
};
void mark_drip(Scene&, int parent, const glm::mat4& frame, float length_m, float catchment_m, float lip_mm,
               DripMark = {});
// Of an awning of that length (shops.cpp): a tip each.
int awning_stripes(float length_m);
void mark_pane(Scene&, int parent, const glm::mat4& frame, glm::vec2 size_m);
// The object of a node mirrors its own surroundings, as captured at a place along the node's axes.
void mark_probe(Scene&, int node, glm::vec3 centre_m, float radius_m);
// Leaves a wake where it moves through standing water.
void mark_wader(Scene&, int node, float radius_m, float draft_mm);

inline const glm::vec3 sodium_light{1.0f, 0.60f, 0.24f};
inline const glm::vec3 white_light{1.0f, 0.86f, 0.68f};

void add_ground(Scene&, const StandingWater&);
void add_buildings(Scene&);
void add_toy_shop(Scene&);
void add_furniture(Scene&);
void add_vehicles(Scene&);
void add_marks(Scene&);
void mark_rain_catchers(Scene&);  // catchers.cpp

// Dry: rain wets it and fills its hollows.
Scene make_city();

}  // namespace petrichor::city
