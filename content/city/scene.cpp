#include "content/city/scene.hpp"

#include <algorithm>
#include <utility>

namespace petrichor::city {

glm::vec3 emission_cd_m2(Glow glow) {
  switch (glow) {
    case Glow::sodium:
      return {2500.0f, 1290.0f, 400.0f};
    case Glow::white:
      return {1900.0f, 1780.0f, 1530.0f};
    case Glow::candle:
      return {900.0f, 450.0f, 140.0f};
    case Glow::neon_red:
      return {430.0f, 6.0f, 2.5f};
    case Glow::neon_pink:
      return {420.0f, 14.0f, 130.0f};
    case Glow::neon_blue:
      return {10.0f, 36.0f, 560.0f};
    case Glow::neon_cyan:
      return {7.0f, 230.0f, 300.0f};
    case Glow::neon_green:
      return {8.0f, 330.0f, 42.0f};
    case Glow::neon_amber:
      return {480.0f, 125.0f, 5.0f};
    case Glow::signal_red:
      return {1100.0f, 9.0f, 3.0f};
    case Glow::signal_green:
      return {8.0f, 850.0f, 300.0f};
    case Glow::headlight:
      return {3000.0f, 2650.0f, 2050.0f};
    case Glow::taillight:
      return {320.0f, 2.6f, 1.2f};
    case Glow::clock:
      return {150.0f, 125.0f, 75.0f};
    case Glow::shop:
      return {220.0f, 140.0f, 62.0f};
    case Glow::strip:
      return {700.0f, 720.0f, 700.0f};
    case Glow::count:
      break;
  }
  return glm::vec3(0.0f);
}

glm::vec2 roughness_metalness(Finish finish) {
  switch (finish) {
    case Finish::matte:
      return {0.85f, 0.0f};
    case Finish::paint:
      return {0.48f, 0.0f};
    case Finish::gloss:
      return {0.12f, 0.0f};
    case Finish::stone:
      return {0.80f, 0.0f};
    case Finish::rubber:
      return {0.75f, 0.0f};
    case Finish::iron:
      return {0.48f, 0.85f};
    case Finish::steel:
      return {0.32f, 1.0f};
    case Finish::chrome:
      return {0.09f, 1.0f};
    case Finish::brass:
      return {0.22f, 1.0f};
    case Finish::count:
      break;
  }
  return {1.0f, 0.0f};
}

glm::vec2 texture_metres(Mat mat) {
  switch (mat) {
    case Mat::stucco:
      return {3.2f, 3.2f};
    case Mat::brick:
      return {2.0f, 1.95f};
    case Mat::ashlar:
      return {2.4f, 2.4f};
    case Mat::tiles:
      return {2.0f, 2.0f};
    case Mat::asphalt:
      return {5.0f, 10.0f};
    case Mat::setts:
      return {3.0f, 3.0f};
    case Mat::slabs:
      return {4.0f, 4.0f};
    default:
      return {1.0f, 1.0f};
  }
}

float texture_relief_m(Mat mat) {
  return mat == Mat::asphalt ? 0.020f : mat == Mat::setts ? 0.040f : 0.0f;
}

bool has_normal_map(Mat mat) {
  switch (mat) {
    case Mat::stucco:
    case Mat::brick:
    case Mat::ashlar:
    case Mat::tiles:
    case Mat::asphalt:
    case Mat::setts:
    case Mat::slabs:
    case Mat::ironwork:
      return true;
    default:
      return false;
  }
}

int Scene::group(const std::string& name) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].parent < 0 && nodes[i].name == name) return static_cast<int>(i);
  }
  Node node;
  node.name = name;
  return add(std::move(node));
}

int Scene::add(Node node) {
  nodes.push_back(std::move(node));
  return static_cast<int>(nodes.size()) - 1;
}

int Scene::add_mesh(Mesh mesh) {
  meshes.push_back(std::move(mesh));
  return static_cast<int>(meshes.size()) - 1;
}

std::size_t triangle_count(const Scene& scene) {
  std::size_t count = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    for (const auto& [mat, primitive] : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
      count += primitive.indices.size() / 3;
    }
  }
  return count;
}

}  // namespace petrichor::city
