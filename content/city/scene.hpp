#pragma once
// What the generator makes before it becomes a .glb: meshes of a few shared materials, nodes, lights.
// Right-handed, y up, metres; textures repeat in metres (texture_metres).

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace petrichor::city {

// One entry per glTF material. Colour varies by vertex (COLOR_0 multiplies the base colour), so whole
// buildings share a handful of materials and draw in a handful of calls.
enum class Mat : std::uint8_t {
  plain,  // paint, metal, rubber, wood: roughness and metalness from a palette texture (Finish)
  glow,   // everything that shines by itself: colours of the emission palette (Glow)
  stucco,
  brick,
  ashlar,
  tiles,
  asphalt,
  setts,
  slabs,
  markings,
  ironwork,   // manhole covers and gratings
  panes,      // windows: dark glass over an atlas of interiors
  shopfront,  // shop windows: the same with goods
  signs,      // painted and lit lettering, posters, plates
  glass,      // the only blended material
  count
};

enum class Finish : std::uint8_t { matte, paint, gloss, stone, rubber, iron, steel, chrome, brass, count };
enum class Glow : std::uint8_t {
  sodium,
  white,
  candle,
  neon_red,
  neon_pink,
  neon_blue,
  neon_cyan,
  neon_green,
  neon_amber,
  signal_red,
  signal_green,
  headlight,
  taillight,
  clock,
  shop,
  strip,
  count
};

// Emission palette, in cd/m2 (white point sRGB). A lamp's glass gives luminance x area = the candela of its light.
glm::vec3 emission_cd_m2(Glow);
// Roughness and metalness of a finish when it is dry.
glm::vec2 roughness_metalness(Finish);
// How many metres one repeat of a material's textures covers, in u and v.
glm::vec2 texture_metres(Mat);
bool has_normal_map(Mat);
// Height that the relief in the red of a material's roughness map spans; 0: there is none.
float texture_relief_m(Mat);

inline constexpr float puddle_depth_unit_m = 0.04f;
inline constexpr float no_puddle_m = -puddle_depth_unit_m;  // higher than any relief: the shore lies where it is 0

struct Vertex {
  glm::vec3 position_m;
  glm::vec3 normal;
  glm::vec2 uv;
  glm::vec3 colour;          // linear, multiplies the base colour
  float puddle_depth_m = no_puddle_m;  // below the brim of its hollow; TEXCOORD_1.x is that / puddle_depth_unit_m
};

struct Primitive {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
};

struct Mesh {
  std::string name;
  std::map<Mat, Primitive> primitives;
};

struct Light {
  std::string name;
  bool spot = false;
  glm::vec3 colour{1.0f};
  float intensity_cd = 100.0f;
  float range_m = 0.0f;
  float inner_cone_rad = 0.0f;
  float outer_cone_rad = 0.7853981634f;
};

struct Camera {
  std::string name;
  float vertical_fov_rad = 0.8f;
};

struct Node {
  std::string name;
  int parent = -1;
  glm::vec3 translation_m{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  int mesh = -1;
  int light = -1;
  int camera = -1;
  std::string extras_json;  // "" or an object: {"drip_source": {...}}
};

struct Scene {
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;
  std::vector<Light> lights;
  std::vector<Camera> cameras;

  int group(const std::string& name);  // an empty root node, found by name or made
  int add(Node node);
  int add_mesh(Mesh mesh);  // moved in; returns its index
};

// Triangles drawn: every node counts the triangles of its mesh.
std::size_t triangle_count(const Scene&);

}  // namespace petrichor::city
