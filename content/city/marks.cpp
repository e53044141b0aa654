// Good places to stand: cameras, and where the walker of the sandbox begins.
#include <glm/gtc/matrix_transform.hpp>

#include "content/city/parts.hpp"
#include "content/city/plan.hpp"

namespace petrichor::city {
namespace {

void view(Scene& scene, int parent, const std::string& name, glm::vec3 eye, glm::vec3 target, float fov_deg) {
  scene.cameras.push_back({name, glm::radians(fov_deg)});
  Node node;
  node.name = name;
  node.parent = parent;
  node.translation_m = eye;
  node.rotation = glm::normalize(glm::quat_cast(glm::inverse(glm::lookAt(eye, target, glm::vec3(0, 1, 0)))));
  node.camera = static_cast<int>(scene.cameras.size()) - 1;
  scene.add(std::move(node));
}

}  // namespace

void add_marks(Scene& scene) {
  const int parent = scene.group("marks");
  view(scene, parent, "view_crossing", {-1.3f, 1.5f, 25.0f}, {1.2f, 3.0f, -10.0f}, 46.0f);
  view(scene, parent, "view_toyshop", {1.2f, 1.55f, 2.6f}, {9.6f, 2.6f, -7.8f}, 52.0f);
  view(scene, parent, "view_under_awning", {15.4f, 1.6f, -6.05f}, {-2.0f, 2.1f, 3.4f}, 60.0f);
  view(scene, parent, "view_roof", {-10.0f, 16.25f, 8.5f}, {7.0f, 4.5f, -7.5f}, 58.0f);
  view(scene, parent, "view_lane", {30.0f, 1.55f, 1.2f}, {-20.0f, 3.4f, -1.5f}, 48.0f);
  Node start;
  start.name = "walker_start";
  start.parent = parent;
  start.translation_m = {-0.8f, 0.1f, 22.0f};
  scene.add(std::move(start));
}

}  // namespace petrichor::city
