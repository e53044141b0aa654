// The glTF 2.0 schema as tables: what each object may hold, so that everything after this file may read the
// JSON without asking again. Source: the JSON schemas of the specification (KhronosGroup/glTF,
// specification/2.0/schema) and of the extensions named.

#include <fmt/format.h>

#include <cfloat>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "engine/assets/gltf_document.hpp"

namespace petrichor {
namespace {

using nlohmann::json;

enum class Kind {
  boolean,
  text,
  texts,
  integer,
  number,
  numbers,
  index,
  indices,
  index_map,
  index_maps,
  object,
  objects
};

struct Table;

struct Member {
  std::string_view name;
  Kind kind;
  bool required = false;
  double minimum = -FLT_MAX;
  double maximum = FLT_MAX;
  std::string_view refers = {};  // index: the top-level array it points into
  const Table* table = nullptr;  // object, objects
  std::size_t length = 0;        // numbers: exact length, 0 for any
};

struct Table {
  std::vector<Member> members;
  std::vector<Member> extensions = {};  // members of "extensions"
};

// Of one array: each costs up to a kilobyte once parsed, and every node becomes an entity.
constexpr std::size_t maximum_objects = 1'000'000;
constexpr double largest_integer = 9007199254740992.0;  // 2^53: exact in a double

Member index(std::string_view name, std::string_view refers, bool required = false) {
  return {name, Kind::index, required, 0, largest_integer, refers};
}
Member indices(std::string_view name, std::string_view refers, bool required = false) {
  return {name, Kind::indices, required, 0, largest_integer, refers};
}
Member text(std::string_view name, bool required = false) {
  return {name, Kind::text, required};
}
Member boolean(std::string_view name) {
  return {name, Kind::boolean};
}
Member whole(std::string_view name, double minimum, double maximum = largest_integer, bool required = false) {
  return {name, Kind::integer, required, minimum, maximum};
}
Member number(std::string_view name, double minimum = -FLT_MAX, double maximum = FLT_MAX, bool required = false) {
  return {name, Kind::number, required, minimum, maximum};
}
Member numbers(std::string_view name, std::size_t length, double minimum = -FLT_MAX) {
  return {name, Kind::numbers, false, minimum, FLT_MAX, {}, nullptr, length};
}
// Bounds that exporters state and nobody here relies on.
Member statistics(std::string_view name) {
  return {name, Kind::numbers, false, -DBL_MAX, DBL_MAX};
}
Member object(std::string_view name, const Table& table, bool required = false) {
  return {name, Kind::object, required, 0, 0, {}, &table};
}
Member objects(std::string_view name, const Table& table, bool required = false) {
  return {name, Kind::objects, required, 0, 0, {}, &table};
}

const Table& root_table() {
  static const Table anything{};
  static const Table asset{{text("version", true), text("minVersion")}};
  static const Table scene{{text("name"), indices("nodes", "nodes")}};
  static const Table node_light{{index("light", "KHR_lights_punctual", true)}};
  static const Table node{
      {text("name"), index("camera", "cameras"), indices("children", "nodes"), index("skin", "skins"),
       index("mesh", "meshes"), numbers("matrix", 16), numbers("rotation", 4), numbers("scale", 3),
       numbers("translation", 3), numbers("weights", 0)},
      {object("KHR_lights_punctual", node_light)}};
  static const Table primitive{{{"attributes", Kind::index_map, true, 0, 0, "accessors"},
                                index("indices", "accessors"),
                                index("material", "materials"),
                                whole("mode", 0, 6),
                                {"targets", Kind::index_maps, false, 0, 0, "accessors"}}};
  static const Table mesh{{text("name"), objects("primitives", primitive, true), numbers("weights", 0)}};
  static const Table sparse_indices{{index("bufferView", "bufferViews", true),
                                     whole("byteOffset", 0, maximum_file_bytes - 1),
                                     whole("componentType", 5121, 5125, true)}};
  static const Table sparse_values{
      {index("bufferView", "bufferViews", true), whole("byteOffset", 0, maximum_file_bytes - 1)}};
  static const Table sparse{{whole("count", 1, 4294967295.0, true), object("indices", sparse_indices, true),
                             object("values", sparse_values, true)}};
  static const Table accessor{{text("name"), index("bufferView", "bufferViews"), whole("byteOffset", 0),
                               whole("componentType", 5120, 5126, true), boolean("normalized"),
                               whole("count", 1, largest_integer, true), text("type", true), statistics("min"),
                               statistics("max"), object("sparse", sparse)}};
  static const Table view{{text("name"), index("buffer", "buffers", true), whole("byteOffset", 0),
                           whole("byteLength", 1, largest_integer, true), whole("byteStride", 4, 252),
                           whole("target", 0, 1e6)}};
  static const Table buffer{{text("name"), text("uri"), whole("byteLength", 1, largest_integer, true)}};
  static const Table image{{text("name"), text("uri"), text("mimeType"), index("bufferView", "bufferViews")}};
  static const Table webp{{index("source", "images", true)}};
  static const Table texture{{text("name"), index("sampler", "samplers"), index("source", "images")},
                             {object("EXT_texture_webp", webp)}};
  static const Table sampler{{text("name"), whole("magFilter", 0, 1e6), whole("minFilter", 0, 1e6),
                              whole("wrapS", 0, 1e6), whole("wrapT", 0, 1e6)}};
  static const Table transform{
      {numbers("offset", 2), number("rotation"), numbers("scale", 2), whole("texCoord", 0, 1e6)}};
  static const Table texture_info{
      {index("index", "textures", true), whole("texCoord", 0, 1e6), number("scale"), number("strength")},
      {object("KHR_texture_transform", transform)}};
  static const Table metallic_roughness{{numbers("baseColorFactor", 4, 0), object("baseColorTexture", texture_info),
                                         number("metallicFactor", 0, 1), number("roughnessFactor", 0, 1),
                                         object("metallicRoughnessTexture", texture_info)}};
  static const Table emissive_strength{{number("emissiveStrength", 0)}};
  static const Table specular_glossiness{
      {numbers("diffuseFactor", 4, 0), object("diffuseTexture", texture_info), number("glossinessFactor", 0, 1)}};
  static const Table material{
      {text("name"), object("pbrMetallicRoughness", metallic_roughness), object("normalTexture", texture_info),
       object("occlusionTexture", texture_info), object("emissiveTexture", texture_info),
       numbers("emissiveFactor", 3, 0), text("alphaMode"), number("alphaCutoff", 0), boolean("doubleSided")},
      {object("KHR_materials_emissive_strength", emissive_strength),
       object("KHR_materials_pbrSpecularGlossiness", specular_glossiness), object("KHR_materials_unlit", anything)}};
  static const Table perspective{{number("aspectRatio", 0), number("yfov", 1e-6, FLT_MAX, true), number("zfar", 0),
                                  number("znear", 1e-12, FLT_MAX, true)}};
  static const Table orthographic{{number("xmag", -FLT_MAX, FLT_MAX, true), number("ymag", -FLT_MAX, FLT_MAX, true),
                                   number("zfar", 0), number("znear", 0)}};
  static const Table camera{
      {text("name"), text("type", true), object("perspective", perspective), object("orthographic", orthographic)}};
  static const Table skin{{text("name"), index("inverseBindMatrices", "accessors"), index("skeleton", "nodes"),
                           indices("joints", "nodes", true)}};
  static const Table animation{{text("name")}};
  static const Table spot{{number("innerConeAngle", 0, 1.5707964), number("outerConeAngle", 0, 1.5707964)}};
  static const Table light{{text("name"), text("type", true), numbers("color", 3, 0), number("intensity", 0),
                            number("range", 0), object("spot", spot)}};
  static const Table lights{{objects("lights", light, true)}};
  static const Table root{{object("asset", asset, true),
                           {"extensionsUsed", Kind::texts},
                           {"extensionsRequired", Kind::texts},
                           index("scene", "scenes"),
                           objects("scenes", scene),
                           objects("nodes", node),
                           objects("meshes", mesh),
                           objects("accessors", accessor),
                           objects("bufferViews", view),
                           objects("buffers", buffer),
                           objects("images", image),
                           objects("textures", texture),
                           objects("samplers", sampler),
                           objects("materials", material),
                           objects("cameras", camera),
                           objects("skins", skin),
                           objects("animations", animation)},
                          {object("KHR_lights_punctual", lights)}};
  return root;
}

// A value as it may stand in a message: short, whatever it is.
std::string shown(const json& value) {
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  if (value.is_object()) return "an object";
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  return text.size() > 60 ? text.substr(0, 60) + "..." : text;
}

class Validator {
 public:
  explicit Validator(json& document) : document_(document) {}

  // The tables nest six deep at most; what nests freely in a glTF (nodes) is flat in its JSON.
  void check(json& value, const Table& table, const std::string& path) {
    if (!value.is_object()) gltf_fail(path, fmt::format("{}, an object is needed", shown(value)));
    for (const Member& member : table.members) check_member(value, member, path);
    const auto extensions = value.find("extensions");
    if (extensions == value.end()) return;
    if (!extensions->is_object())
      gltf_fail(path + "/extensions", fmt::format("{}, an object is needed", shown(*extensions)));
    for (const Member& member : table.extensions) check_member(*extensions, member, path + "/extensions");
  }

 private:
  void check_member(json& parent, const Member& member, const std::string& parent_path) {
    const auto found = parent.find(member.name);
    if (found == parent.end()) {
      if (member.required) gltf_fail(parent_path, fmt::format("\"{}\" is missing", member.name));
      return;
    }
    const std::string path = fmt::format("{}/{}", parent_path, member.name);
    json& value = *found;
    switch (member.kind) {
      case Kind::boolean:
        if (!value.is_boolean()) gltf_fail(path, fmt::format("{}, true or false is needed", shown(value)));
        break;
      case Kind::text:
        if (!value.is_string()) gltf_fail(path, fmt::format("{}, a string is needed", shown(value)));
        break;
      case Kind::texts:
        each(value, path, [&](json& element, const std::string& at) {
          if (!element.is_string()) gltf_fail(at, fmt::format("{}, a string is needed", shown(element)));
        });
        break;
      case Kind::integer:
        check_integer(value, member.minimum, member.maximum, path);
        break;
      case Kind::number:
        check_number(value, member, path);
        break;
      case Kind::numbers:
        each(value, path, [&](json& element, const std::string& at) { check_number(element, member, at); });
        if (member.length != 0 && value.size() != member.length) {
          gltf_fail(path, fmt::format("{} numbers, {} are needed", value.size(), member.length));
        }
        break;
      case Kind::index:
        check_index(value, member.refers, path);
        break;
      case Kind::indices:
        each(value, path, [&](json& element, const std::string& at) { check_index(element, member.refers, at); });
        break;
      case Kind::index_map:
        check_index_map(value, member.refers, path);
        break;
      case Kind::index_maps:
        each(value, path, [&](json& element, const std::string& at) { check_index_map(element, member.refers, at); });
        break;
      case Kind::object:
        check(value, *member.table, path);
        break;
      case Kind::objects:
        if (value.is_array() && value.size() > maximum_objects) {
          gltf_fail(path, fmt::format("{} elements, at most {} are read", value.size(), maximum_objects));
        }
        each(value, path, [&](json& element, const std::string& at) { check(element, *member.table, at); });
        break;
    }
  }

  template <class Use>
  void each(json& value, const std::string& path, Use&& use) {
    if (!value.is_array()) gltf_fail(path, fmt::format("{}, an array is needed", shown(value)));
    for (std::size_t i = 0; i < value.size(); ++i) use(value[i], fmt::format("{}/{}", path, i));
  }

  void check_integer(json& value, double minimum, double maximum, const std::string& path) {
    if (!value.is_number()) gltf_fail(path, fmt::format("{}, an integer is needed", shown(value)));
    const double real = value.get<double>();
    if (real != std::floor(real)) gltf_fail(path, fmt::format("{}, an integer is needed", shown(value)));
    if (!(real >= minimum && real <= maximum)) {
      gltf_fail(path, fmt::format("{}, an integer from {:.0f} to {:.0f} is needed", shown(value), minimum, maximum));
    }
    value = static_cast<std::uint64_t>(real);
    if (path.ends_with("/byteStride") && value.get<std::uint64_t>() % 4 != 0) {
      gltf_fail(path, fmt::format("{}, a multiple of 4 is needed", shown(value)));
    }
  }

  void check_number(const json& value, const Member& member, const std::string& path) {
    if (!value.is_number()) gltf_fail(path, fmt::format("{}, a number is needed", shown(value)));
    const double real = value.get<double>();
    if (!(real >= member.minimum && real <= member.maximum)) {
      gltf_fail(path,
                fmt::format("{}, a number from {:g} to {:g} is needed", shown(value), member.minimum, member.maximum));
    }
  }

  void check_index(json& value, std::string_view refers, const std::string& path) {
    check_integer(value, 0, largest_integer, path);
    const std::size_t size = size_of(refers);
    if (value.get<std::uint64_t>() >= size) {
      gltf_fail(path, fmt::format("{} is asked for, there are {} {}", shown(value), size,
                                  refers == "KHR_lights_punctual" ? "lights" : refers));
    }
  }

  void check_index_map(json& value, std::string_view refers, const std::string& path) {
    if (!value.is_object()) gltf_fail(path, fmt::format("{}, an object is needed", shown(value)));
    for (auto& [key, element] : value.items())
      check_index(element, refers, fmt::format("{}/{}", path, key.substr(0, 60)));
  }

  std::size_t size_of(std::string_view name) const {
    const json* list = nullptr;
    if (name == "KHR_lights_punctual") {
      const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
      if (document_.contains(lights)) list = &document_.at(lights);
    } else if (const auto found = document_.find(name); found != document_.end()) {
      list = &*found;
    }
    return list && list->is_array() ? list->size() : 0;
  }

  json& document_;
};

}  // namespace

void validate_json(json& document) {
  Validator(document).check(document, root_table(), "");
}

}  // namespace petrichor
