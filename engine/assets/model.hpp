#pragma once
// What a glTF file becomes: plain arrays, no library types, valid by construction. Every index in a Model
// is in range, every number finite, every node reached once from the roots, parents before children.

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace petrichor {

inline constexpr std::int32_t no_index = -1;

// One or more channels of one image, decoded to 8-bit RGBA or (for float images) linear half floats.
struct Image {
  int width = 0;
  int height = 0;
  bool is_float = false;             // pixels holds 4 x float per texel instead of 4 x uint8
  std::vector<std::uint8_t> pixels;  // row-major from the top, RGBA
  std::string name;                  // file or JSON path, for messages
};

enum class Wrap : std::uint8_t { repeat, clamp, mirror };

// A texture as a material uses it: image, sampler, UV set and KHR_texture_transform.
struct TextureUse {
  std::int32_t image = no_index;
  std::uint8_t texcoord = 0;  // 0 or 1
  Wrap wrap_u = Wrap::repeat;
  Wrap wrap_v = Wrap::repeat;
  bool nearest = false;
  glm::vec2 offset{0.0f};
  glm::vec2 scale{1.0f};
  float rotation_rad = 0.0f;
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

struct Material {
  std::string name;
  glm::vec4 base_colour{1.0f};
  float metallic = 1.0f;
  float roughness = 1.0f;
  glm::vec3 emissive{0.0f};  // factor x KHR_materials_emissive_strength, in cd/m2
  float normal_scale = 1.0f;
  float occlusion_strength = 1.0f;
  float alpha_cutoff = 0.5f;
  AlphaMode alpha_mode = AlphaMode::opaque;
  bool double_sided = false;
  bool unlit = false;  // KHR_materials_unlit: the base colour is what is seen, lights do not matter
  TextureUse base_colour_texture, metallic_roughness_texture, normal_texture, occlusion_texture, emissive_texture;
  TextureUse hollow_texture;  // extras.water.texture: its red is the depth of hollows (systems/wet_materials.hpp)
  std::string extras_json;  // "" or a JSON object
};

struct Vertex {
  glm::vec3 position_m{0.0f};
  glm::vec3 normal{0.0f, 1.0f, 0.0f};
  glm::vec4 tangent{1.0f, 0.0f, 0.0f, 1.0f};  // w: handedness
  glm::vec2 uv0{0.0f};
  glm::vec2 uv1{0.0f};
  glm::vec4 colour{1.0f};
};

// Triangles only: strips and fans are unrolled, points and lines left out with a warning.
struct Primitive {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // a multiple of three, each < vertices.size()
  std::int32_t material = no_index;
  glm::vec3 bounds_min_m{0.0f};
  glm::vec3 bounds_max_m{0.0f};
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
};

enum class ModelLightKind : std::uint8_t { point, spot, directional };

struct ModelLight {
  std::string name;
  ModelLightKind kind = ModelLightKind::point;
  glm::vec3 colour{1.0f};
  float intensity = 1.0f;  // candela, or lux where directional
  float range_m = 0.0f;    // 0: none given
  float inner_cone_rad = 0.0f;
  float outer_cone_rad = 0.7853981634f;
};

struct ModelCamera {
  std::string name;
  float vertical_fov_rad = 1.0f;
  float near_m = 0.1f;
};

struct Node {
  std::string name;
  std::int32_t parent = no_index;  // always smaller than the node's own index
  glm::vec3 translation_m{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec3 scale{1.0f};
  std::int32_t mesh = no_index;
  std::int32_t light = no_index;
  std::int32_t camera = no_index;
  std::string extras_json;  // "" or a JSON object: components ride here
  std::string json_path;    // "/nodes/12", for messages
};

struct Model {
  std::string source;  // the file
  std::vector<Node> nodes;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Image> images;
  std::vector<ModelLight> lights;
  std::vector<ModelCamera> cameras;
  std::vector<std::string> warnings;
};

// .gltf or .glb. Never crashes or hangs on any bytes; the error names the file and the JSON path.
Result<Model> load_model(const std::filesystem::path& file);

// World-space bounds of all mesh nodes; false where there is no triangle.
bool model_bounds(const Model&, glm::vec3& minimum_m, glm::vec3& maximum_m);

}  // namespace petrichor
