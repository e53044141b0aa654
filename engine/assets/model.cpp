#include "engine/assets/model.hpp"

#include <fmt/format.h>

#include <exception>
#include <limits>

#include "engine/assets/gltf_document.hpp"

namespace petrichor {

// The one place where failures inside the box become values; whatever a library throws ends here too.
Result<Model> load_model(const std::filesystem::path& file) {
  const auto failed = [&](const std::string& path, const std::string& message) {
    return failure(path.empty() ? fmt::format("{}: {}", file.string(), message)
                                : fmt::format("{}: {}: {}", file.string(), path, message));
  };
  try {
    Document document;
    open_document(document, file);
    Model model;
    model.source = file.string();
    convert_images(document, model);
    convert_materials(document, model);
    convert_nodes(document, model);
    model.warnings = std::move(document.warnings);
    return model;
  } catch (const GltfError& error) {
    return failed(error.path, error.message);
  } catch (const std::bad_alloc&) {
    return failed("", "not enough memory for this model");
  } catch (const std::exception& error) {
    return failed("", error.what());
  }
}

bool model_bounds(const Model& model, glm::vec3& minimum_m, glm::vec3& maximum_m) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  struct Box {
    glm::vec3 low{inf}, high{-inf};
    bool empty() const { return low.x > high.x; }
  };
  std::vector<Box> boxes(model.meshes.size());
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    for (const Primitive& p : model.meshes[i].primitives) {
      boxes[i].low = glm::min(boxes[i].low, p.bounds_min_m);
      boxes[i].high = glm::max(boxes[i].high, p.bounds_max_m);
    }
  }
  Box all;
  std::vector<glm::mat4> worlds;
  worlds.reserve(model.nodes.size());
  for (const Node& node : model.nodes) {
    glm::mat4 local = glm::mat4_cast(node.rotation);
    for (int c = 0; c < 3; ++c) local[c] *= node.scale[c];
    local[3] = glm::vec4(node.translation_m, 1.0f);
    worlds.push_back(node.parent == no_index ? local : worlds[static_cast<std::size_t>(node.parent)] * local);
    if (node.mesh == no_index) continue;
    const Box& box = boxes[static_cast<std::size_t>(node.mesh)];
    if (box.empty()) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 local_corner(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                   corner & 4 ? box.high.z : box.low.z);
      const glm::vec3 at(worlds.back() * glm::vec4(local_corner, 1.0f));
      all.low = glm::min(all.low, at);
      all.high = glm::max(all.high, at);
    }
  }
  if (all.empty()) return false;
  minimum_m = all.low;
  maximum_m = all.high;
  return true;
}

}  // namespace petrichor
