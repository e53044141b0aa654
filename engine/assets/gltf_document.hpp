#pragma once
// Inside the assets box: one glTF file on its way to becoming a Model. Not for other boxes.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/assets/source_file.hpp"

namespace tinygltf {
class Model;
struct Primitive;
}  // namespace tinygltf

namespace petrichor {

// Thrown inside the box only; load_model turns it into a Result. `path` is a JSON pointer or "".
struct GltfError {
  std::string path;
  std::string message;
};

[[noreturn]] void gltf_fail(std::string path, std::string message);

struct AccessorView;

inline constexpr float largest_position_m = 1e12f;  // squares and cubes of it stay finite floats

struct Document {
  Document();
  ~Document();
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  std::filesystem::path file;
  Bytes file_bytes;
  std::unique_ptr<nlohmann::json> json;     // the file's JSON, checked by validate_json
  std::unique_ptr<tinygltf::Model> gltf;    // parsed from it; what is left out: for_tinygltf()
  std::span<const std::uint8_t> glb_chunk;  // BIN, empty where there is none
  std::vector<std::span<const std::uint8_t>> buffers;
  std::map<std::string, Bytes> external_files;  // by path: several URIs may name one file
  std::vector<Bytes> data_uris;
  std::map<int, std::unique_ptr<AccessorView>> sparse_accessors;
  std::uint64_t vertex_count = 0;  // of the whole model, against the caps
  std::uint64_t index_count = 0;
  std::uint64_t zero_elements = 0;  // read from accessors that have no data
  std::uint64_t dense_bytes = 0;    // of sparse_accessors

  void warn(const std::string& path, const std::string& message);
  std::vector<std::string> warnings;
};

// Reads the container (.gltf or .glb, told apart by the first bytes), checks and parses the JSON, and finds
// the bytes of every buffer.
void open_document(Document&, const std::filesystem::path& file);

// Types, required members, ranges and indices of everything that this loader reads, by the tables of the
// glTF 2.0 schema. Integers written as 3.0 become integers.
void validate_json(nlohmann::json&);

// Extensions: an unknown required one is an error, an unknown optional one a warning.
void check_extensions(Document&);

// The bytes of a URI or, for data: URIs, of the URI itself. They live as long as the document.
std::span<const std::uint8_t> bytes_of_uri(Document&, const std::string& uri, const std::string& path);

// The bytes of /bufferViews/<index>, checked against its buffer.
std::span<const std::uint8_t> bytes_of_view(const Document&, int index);

// The steps from Document to Model; each fills its part.
void convert_images(Document&, Model&);
void convert_materials(Document&, Model&);
void convert_nodes(Document&, Model&);  // scene, nodes, meshes, lights, cameras

// Where the joints of /skins/<skin> stand: world transform x inverse bind matrix, each.
struct SkinPose {
  int skin = no_index;
  std::vector<glm::dmat4> joints;
};
SkinPose pose_of_skin(Document&, int skin, const std::function<glm::dmat4(std::size_t)>& world_of_node);

// Moves out.vertices, which were read from the source vertices `used`, to world space.
void apply_pose(Document&, const tinygltf::Primitive& source, const std::vector<std::uint32_t>& used, const SkinPose&,
                Primitive& out, const std::string& path);

// One mesh with the given morph weights applied, posed by its skin if there is one.
Mesh convert_mesh(Document&, const Model&, int mesh_index, const std::vector<double>& weights,
                  const SkinPose* = nullptr);

// Fills Vertex::tangent. `uv1`: whether the normal texture uses the second set of coordinates; `exact` splits
// vertices where mirrored halves meet.
void compute_tangents(Primitive&, bool uv1, bool exact);

}  // namespace petrichor
