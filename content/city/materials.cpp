#include "content/city/materials.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "content/city/atlases.hpp"
#include "content/city/textures.hpp"

namespace petrichor::city {
namespace {

using nlohmann::json;

constexpr int palette_px = 64;
constexpr float glow_strength_cd_m2 = 3000.0f;

const char* mat_name(Mat mat) {
  static const std::array<const char*, static_cast<std::size_t>(Mat::count)> names{
      "plain", "glow",          "stucco",   "brick",        "ashlar",    "roof_tiles", "asphalt", "setts",
      "slabs", "road_markings", "ironwork", "window_panes", "shopfront", "signs",      "glass"};
  return names[static_cast<std::size_t>(mat)];
}

template <class CellColour>
Picture palette(CellColour&& colour) {
  Picture out(palette_px, palette_px);
  for (int y = 0; y < palette_px; ++y) {
    for (int x = 0; x < palette_px; ++x) {
      const glm::vec3 c = colour((y * 8 / palette_px) * 8 + x * 8 / palette_px);
      for (int k = 0; k < 3; ++k) out.at(x, y)[k] = to_byte(c[k]);
    }
  }
  return out;
}

Picture finish_palette() {
  return palette([](int cell) {
    if (cell >= static_cast<int>(Finish::count)) return glm::vec3(1.0f, 1.0f, 0.0f);
    const glm::vec2 rm = roughness_metalness(static_cast<Finish>(cell));
    return glm::vec3(1.0f, rm.x, rm.y);
  });
}

Picture glow_palette() {
  return palette([](int cell) {
    if (cell >= static_cast<int>(Glow::count)) return glm::vec3(0.0f);
    const glm::vec3 e = emission_cd_m2(static_cast<Glow>(cell)) / glow_strength_cd_m2;
    return glm::vec3(to_srgb(e.x), to_srgb(e.y), to_srgb(e.z));
  });
}

struct Maker {
  MaterialSet set;

  json texture(const std::string& name, const Picture& picture, const char* format) {
    set.images.push_back({name, std::string(format) == "png" ? "image/png" : "image/jpeg", encode(picture, format)});
    return {{"index", set.images.size() - 1}};
  }

  json tiled(const char* name, const Maps& maps) {
    json m;
    m["pbrMetallicRoughness"]["baseColorTexture"] =
        texture(std::string(name) + "_base_colour", maps.base_colour, "jpg");
    m["pbrMetallicRoughness"]["metallicRoughnessTexture"] =
        texture(std::string(name) + "_roughness", maps.roughness_metalness, "jpg");
    m["normalTexture"] = texture(std::string(name) + "_normal", maps.normal, "jpg");
    return m;
  }

  // Ground where water may stand (systems/wet_materials.hpp): the vertices say how deep, the relief how far stones
  // rise out of it.
  json hollowed(const char* name, const Maps& maps, Mat mat) {
    json m = tiled(name, maps);
    const Picture& relief = maps.roughness_metalness;
    double sum = 0.0;
    for (std::size_t i = 0; i < relief.rgb.size(); i += 3) sum += relief.rgb[i];
    json& water = m["extras"]["water"];
    water = {
        {"hollow", "texcoord_1"}, {"maximum_depth_mm", 1000.0f * puddle_depth_unit_m}, {"tint", {0.72, 0.68, 0.58}}};
    if (texture_relief_m(mat) > 0.0f) {
      water["relief_mm"] = 1000.0f * texture_relief_m(mat);
      water["relief_mean"] = sum * 3.0 / static_cast<double>(relief.rgb.size()) / 255.0;
    }
    return m;
  }

  json lit(const char* name, const Atlas& atlas, float strength, float roughness) {
    json m;
    m["pbrMetallicRoughness"] = {{"metallicFactor", 0.0}, {"roughnessFactor", roughness}};
    m["pbrMetallicRoughness"]["baseColorTexture"] =
        texture(std::string(name) + "_base_colour", atlas.base_colour, "jpg");
    m["emissiveTexture"] = texture(std::string(name) + "_emission", atlas.emission, "jpg");
    emit(m, strength);
    return m;
  }

  static void emit(json& m, float strength) {
    m["emissiveFactor"] = {1.0, 1.0, 1.0};
    m["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
  }
};

json make(Maker& maker, Mat mat) {
  json m;
  switch (mat) {
    case Mat::plain:
      m["pbrMetallicRoughness"]["metallicRoughnessTexture"] = maker.texture("finishes", finish_palette(), "png");
      return m;
    case Mat::glow:
      m["pbrMetallicRoughness"] = {
          {"baseColorFactor", {0.02, 0.02, 0.02, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.2}};
      m["emissiveTexture"] = maker.texture("glows", glow_palette(), "png");
      Maker::emit(m, glow_strength_cd_m2);
      return m;
    case Mat::stucco:
      return maker.tiled("stucco", stucco_maps());
    case Mat::brick:
      return maker.tiled("brick", brick_maps());
    case Mat::ashlar:
      return maker.tiled("ashlar", ashlar_maps());
    case Mat::tiles:
      return maker.tiled("roof_tiles", tile_maps());
    case Mat::asphalt:
      return maker.hollowed("asphalt", asphalt_maps(), Mat::asphalt);
    case Mat::setts:
      return maker.hollowed("setts", setts_maps(), Mat::setts);
    case Mat::slabs:
      return maker.tiled("slabs", slabs_maps());
    case Mat::ironwork:
      return maker.tiled("ironwork", ironwork_maps());
    case Mat::markings:
      m = maker.hollowed("markings", marking_maps(), Mat::markings);
      m.erase("normalTexture");
      maker.set.images.pop_back();
      return m;
    case Mat::panes:
      return maker.lit("panes", pane_atlas(), pane_strength_cd_m2, 0.06f);
    case Mat::shopfront:
      return maker.lit("shopfront", shopfront_atlas(), shopfront_strength_cd_m2, 0.05f);
    case Mat::signs:
      return maker.lit("signs", sign_atlas(), sign_strength_cd_m2, 0.25f);
    case Mat::glass:
      m["pbrMetallicRoughness"] = {
          {"baseColorFactor", {0.02, 0.025, 0.025, 0.10}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.03}};
      m["alphaMode"] = "BLEND";
      m["doubleSided"] = true;
      return m;
    case Mat::count:
      break;
  }
  return m;
}

}  // namespace

MaterialSet make_materials(const Scene& scene, bool textures) {
  std::set<Mat> used;
  for (const Mesh& mesh : scene.meshes) {
    for (const auto& [mat, primitive] : mesh.primitives) used.insert(mat);
  }
  Maker maker;
  maker.set.index_of.assign(static_cast<std::size_t>(Mat::count), -1);
  for (Mat mat : used) {
    json m = textures ? make(maker, mat) : json::object();
    m["name"] = mat_name(mat);
    maker.set.index_of[static_cast<std::size_t>(mat)] = static_cast<int>(maker.set.json.size());
    maker.set.json.push_back(m.dump());
  }
  return std::move(maker.set);
}

}  // namespace petrichor::city
