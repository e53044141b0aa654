// Images, textures and materials of a glTF (specification 2.0, sections 3.8 and 3.9).

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "engine/assets/gltf_document.hpp"
#include "engine/assets/image.hpp"

namespace petrichor {
namespace {

using nlohmann::json;

constexpr std::uint64_t maximum_all_pixel_bytes = 4ull << 30;

const json& member(const json& parent, const char* name) {
  static const json none;
  const auto found = parent.find(name);  // end() where parent is no object
  return found != parent.end() ? *found : none;
}

const json& extension(const json& parent, const char* name) {
  return member(member(parent, "extensions"), name);
}

glm::vec3 vec3_or(const json& parent, const char* name, glm::vec3 otherwise) {
  const json& list = member(parent, name);
  return list.is_array() ? glm::vec3(list[0].get<float>(), list[1].get<float>(), list[2].get<float>()) : otherwise;
}

glm::vec2 vec2_or(const json& parent, const char* name, glm::vec2 otherwise) {
  const json& list = member(parent, name);
  return list.is_array() ? glm::vec2(list[0].get<float>(), list[1].get<float>()) : otherwise;
}

// An image that only an extension we lack can use, beside the PNG or JPEG that everybody reads.
bool only_for_extensions(const json& image) {
  static const std::set<std::string> types{"image/ktx2", "image/vnd-ms.dds", "image/avif"};
  return types.contains(image.value("mimeType", std::string()));
}

Wrap wrap_of(int gl_constant) {
  if (gl_constant == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
  if (gl_constant == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::mirror;
  return Wrap::repeat;
}

TextureUse convert_texture(Document& document, const json& info, const std::string& path) {
  TextureUse use;
  if (!info.is_object()) return use;
  const std::size_t index = info["index"];
  const tinygltf::Texture& texture = document.gltf->textures[index];
  const json& webp = extension((*document.json)["textures"][index], "EXT_texture_webp");
  use.image = webp.is_object() ? webp["source"].get<std::int32_t>() : texture.source;
  if (use.image < 0) {
    document.warn(fmt::format("/textures/{}", index), "has no source that can be read");
    return use;
  }
  if (only_for_extensions((*document.json)["images"][static_cast<std::size_t>(use.image)])) {
    document.warn(path, fmt::format("/images/{} is of a type that cannot be read; the texture is left out", use.image));
    use.image = no_index;
    return use;
  }
  if (texture.sampler >= 0) {
    const tinygltf::Sampler& sampler = document.gltf->samplers[static_cast<std::size_t>(texture.sampler)];
    use.wrap_u = wrap_of(sampler.wrapS);
    use.wrap_v = wrap_of(sampler.wrapT);
    use.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  int texcoord = info.value("texCoord", 0);
  const json& transform = extension(info, "KHR_texture_transform");
  if (transform.is_object()) {
    use.offset = vec2_or(transform, "offset", use.offset);
    use.scale = vec2_or(transform, "scale", use.scale);
    use.rotation_rad = transform.value("rotation", 0.0f);
    texcoord = transform.value("texCoord", texcoord);
  }
  if (texcoord > 1) {
    document.warn(path, fmt::format("texture coordinates {} are not read, 0 takes their place", texcoord));
    texcoord = 0;
  }
  use.texcoord = static_cast<std::uint8_t>(texcoord);
  return use;
}

Material convert_material(Document& document, std::size_t index) {
  const tinygltf::Material& source = document.gltf->materials[index];
  const json& raw = (*document.json)["materials"][index];
  const json& surface = member(raw, "pbrMetallicRoughness");
  const std::string path = fmt::format("/materials/{}", index);
  Material out;
  out.name = source.name;
  const auto& pbr = source.pbrMetallicRoughness;
  for (int c = 0; c < 4; ++c) out.base_colour[c] = static_cast<float>(pbr.baseColorFactor[static_cast<std::size_t>(c)]);
  out.metallic = static_cast<float>(pbr.metallicFactor);
  out.roughness = static_cast<float>(pbr.roughnessFactor);
  const json& strength = member(extension(raw, "KHR_materials_emissive_strength"), "emissiveStrength");
  out.emissive =
      vec3_or(raw, "emissiveFactor", glm::vec3(0.0f)) * (strength.is_number() ? strength.get<float>() : 1.0f);
  out.normal_scale = static_cast<float>(source.normalTexture.scale);
  out.occlusion_strength = static_cast<float>(source.occlusionTexture.strength);
  out.alpha_cutoff = static_cast<float>(source.alphaCutoff);
  out.double_sided = source.doubleSided;
  out.unlit = extension(raw, "KHR_materials_unlit").is_object();
  if (source.alphaMode == "MASK")
    out.alpha_mode = AlphaMode::mask;
  else if (source.alphaMode == "BLEND")
    out.alpha_mode = AlphaMode::blend;
  else if (source.alphaMode != "OPAQUE") {
    document.warn(path + "/alphaMode",
                  fmt::format("\"{}\" is none of OPAQUE, MASK, BLEND", source.alphaMode.substr(0, 40)));
  }
  for (int c = 0; c < 3; ++c) {
    if (!(out.emissive[c] <= 1e30f)) gltf_fail(path, "emissiveFactor times emissiveStrength is no finite number");
  }
  out.base_colour_texture =
      convert_texture(document, member(surface, "baseColorTexture"), path + "/pbrMetallicRoughness/baseColorTexture");
  out.metallic_roughness_texture = convert_texture(document, member(surface, "metallicRoughnessTexture"),
                                                   path + "/pbrMetallicRoughness/metallicRoughnessTexture");
  if (const json& old = extension(raw, "KHR_materials_pbrSpecularGlossiness"); old.is_object()) {
    // Of old exporters. What is metal cannot be told from it cheaply; buildings seldom are.
    const json& diffuse = member(old, "diffuseFactor");
    for (int c = 0; c < 4; ++c) {
      out.base_colour[c] = diffuse.is_array() ? diffuse[static_cast<std::size_t>(c)].get<float>() : 1.0f;
    }
    const json& glossiness = member(old, "glossinessFactor");
    out.roughness = 1.0f - (glossiness.is_number() ? glossiness.get<float>() : 1.0f);
    out.metallic = 0.0f;
    out.metallic_roughness_texture = {};
    out.base_colour_texture = convert_texture(document, member(old, "diffuseTexture"),
                                              path + "/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture");
  }
  out.normal_texture = convert_texture(document, member(raw, "normalTexture"), path + "/normalTexture");
  out.occlusion_texture = convert_texture(document, member(raw, "occlusionTexture"), path + "/occlusionTexture");
  out.emissive_texture = convert_texture(document, member(raw, "emissiveTexture"), path + "/emissiveTexture");
  if (const json& extras = member(raw, "extras"); extras.is_object()) {
    out.extras_json = extras.dump(-1, ' ', false, json::error_handler_t::replace);
    if (const json& hollow = member(member(extras, "water"), "texture"); hollow.is_object()) {
      // Extras are nobody's to validate but ours.
      const json& texture = member(hollow, "index");
      const json& set = member(hollow, "texCoord");
      const std::string place = path + "/extras/water/texture";
      if (!texture.is_number_unsigned() || texture.get<std::uint64_t>() >= document.gltf->textures.size())
        gltf_fail(place + "/index", "no texture of this file");
      if (!set.is_null() && (!set.is_number_unsigned() || set.get<std::uint64_t>() > 1))
        gltf_fail(place + "/texCoord", "neither 0 nor 1");
      out.hollow_texture =
          convert_texture(document, {{"index", texture}, {"texCoord", set.is_null() ? json(0) : set}}, place);
    }
  }
  return out;
}

}  // namespace

// Decoding is what takes time in a model with textures: images share the cores. Errors come in file order.
void convert_images(Document& document, Model& model) {
  const json& images = member(*document.json, "images");
  struct Job {
    std::span<const std::uint8_t> bytes;
    std::string name;
    Result<Image> image = Image{};
  };
  std::vector<Job> jobs(images.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string path = fmt::format("/images/{}", i);
    if (only_for_extensions(images[i])) continue;
    const bool has_uri = images[i].contains("uri");
    if (has_uri == images[i].contains("bufferView")) gltf_fail(path, "either a uri or a bufferView is needed");
    jobs[i].name = path;
    if (has_uri) {
      const std::string& uri = images[i]["uri"].get_ref<const std::string&>();
      jobs[i].bytes = bytes_of_uri(document, uri, path + "/uri");
      if (!is_data_uri(uri)) jobs[i].name += ": " + uri.substr(0, 200);
    } else {
      jobs[i].bytes = bytes_of_view(document, images[i]["bufferView"].get<int>());
    }
  }

  std::atomic<std::size_t> next{0};
  std::atomic<std::uint64_t> all_bytes{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs.size(); i = next++) {
      if (jobs[i].name.empty() || all_bytes > maximum_all_pixel_bytes) continue;
      jobs[i].image = decode_image(jobs[i].bytes, jobs[i].name);
      if (jobs[i].image) all_bytes += jobs[i].image->pixels.size();
    }
  };
  {
    const std::size_t threads = std::min<std::size_t>({jobs.size(), std::thread::hardware_concurrency(), 8});
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < threads; ++i) helpers.emplace_back(work);
    work();
  }
  for (Job& job : jobs) {
    if (!job.image) gltf_fail(job.name, job.image.error().message);
    model.images.push_back(std::move(*job.image));
  }
  if (all_bytes > maximum_all_pixel_bytes)
    gltf_fail("/images", fmt::format("together they pass {} bytes", maximum_all_pixel_bytes));
}

void convert_materials(Document& document, Model& model) {
  for (std::size_t i = 0; i < document.gltf->materials.size(); ++i) {
    model.materials.push_back(convert_material(document, i));
  }
}

}  // namespace petrichor
