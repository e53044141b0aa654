#include "systems/wet_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

namespace petrichor {
namespace {

using nlohmann::json;

// Throws nothing: the first thing that is wrong stands in `wrong`.
struct Reader {
  const json& object;
  std::string wrong = {};

  void fail(std::string_view key, const std::string& what) {
    if (wrong.empty()) wrong = fmt::format("extras.water.{}: {}", key, what);
  }
  void number(const char* key, double low, double high, float& out) {
    const auto found = object.find(key);
    if (found == object.end()) return;
    if (!found->is_number() || !(found->get<double>() >= low && found->get<double>() <= high))
      return fail(key, fmt::format("{} is no number from {} to {}", found->dump().substr(0, 60), low, high));
    out = found->get<float>();
  }
};

std::string read(const json& extras, const Material& material, MaterialWater& out) {
  const auto found = extras.find("water");
  if (found == extras.end()) return {};
  if (found->is_boolean()) {
    out.wets = found->get<bool>();
    return {};
  }
  if (!found->is_object()) return "extras.water: an object or false is needed";
  Reader in{*found};
  static constexpr std::array<std::string_view, 10> keys{
      "hollow",   "texture", "maximum_depth_mm", "relief_mm",    "relief_mean",
      "porosity", "tint",    "ripple_influence", "ripple_scale", "ripple_turn_deg"};
  for (const auto& [key, value] : found->items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      in.fail(key.substr(0, 60), fmt::format("no such field; there are {}", fmt::join(keys, ", ")));

  if (const auto hollow = found->find("hollow"); hollow != found->end()) {
    static constexpr std::array<std::string_view, 4> names{"none", "texcoord_1", "vertex_colour", "texture"};
    const auto name = std::find(names.begin(), names.end(), hollow->is_string() ? hollow->get<std::string>() : "");
    if (name == names.end())
      in.fail("hollow", fmt::format("{} is none of {}", hollow->dump().substr(0, 60), fmt::join(names, ", ")));
    else
      out.hollow = static_cast<Hollow>(name - names.begin());
  }
  if (out.hollow == Hollow::texture && material.hollow_texture.image == no_index)
    in.fail("texture", "hollow is \"texture\", so \"texture\": {\"index\": a texture of the file} is needed");

  float depth_mm = 30.0f, relief_mm = 0.0f, turn_deg = 0.0f;
  in.number("maximum_depth_mm", 0.1, 10000.0, depth_mm);
  in.number("relief_mm", 0.0, 1000.0, relief_mm);
  in.number("relief_mean", 0.0, 1.0, out.relief_mean);
  in.number("porosity", 0.0, 1.0, out.gpu.ripple.w);
  in.number("ripple_influence", 0.0, 1.0, out.gpu.ripple.x);
  in.number("ripple_scale", 0.01, 100.0, out.gpu.ripple.y);
  in.number("ripple_turn_deg", -36000.0, 36000.0, turn_deg);
  out.gpu.ripple.z = turn_deg * 0.017453293f;
  if (relief_mm > 0.0f && material.metallic_roughness_texture.image == no_index)
    in.fail("relief_mm", "the relief is the red of the metallicRoughnessTexture, and there is none");
  if (out.hollow != Hollow::none) {
    out.gpu.absorption_depth.w = 1e-3f * depth_mm;
    out.relief = relief_mm / depth_mm;
  }
  if (const auto tint = found->find("tint"); tint != found->end()) {
    const bool three =
        tint->is_array() && tint->size() == 3 && std::all_of(tint->begin(), tint->end(), [](const json& c) {
          return c.is_number() && c.get<double>() >= 0.0 && c.get<double>() <= 1.0;
        });
    if (!three)
      in.fail("tint", "three numbers from 0 to 1 are needed");
    else
      for (int c = 0; c < 3; ++c)  // through 0.1 m; black is as good as 1e-6
        out.gpu.absorption_depth[c] =
            -std::log(std::max((*tint)[static_cast<std::size_t>(c)].get<float>(), 1e-6f)) / 0.1f;
  }
  return in.wrong;
}

}  // namespace

Result<std::vector<MaterialWater>> read_material_water(const Model& model) {
  std::vector<MaterialWater> out(model.materials.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Material& m = model.materials[i];
    out[i].wets = !m.unlit;  // no light, no film to see
    if (m.extras_json.empty()) continue;
    const json extras = json::parse(m.extras_json, nullptr, false);
    if (!extras.is_object()) continue;
    if (const std::string wrong = read(extras, m, out[i]); !wrong.empty())
      return failure(fmt::format("{}: /materials/{} ({}): {}", model.source, i, m.name, wrong));
  }
  return out;
}

}  // namespace petrichor
