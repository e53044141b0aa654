#include "systems/occlusion/street.hpp"

#include <cmath>

namespace petrichor {
namespace {

void add_side(Primitive& p, glm::vec3 a, glm::vec3 u, glm::vec3 v) {
  const auto first = static_cast<std::uint32_t>(p.vertices.size());
  const glm::vec3 normal = glm::normalize(glm::cross(u, v));
  for (const glm::vec3& at : {a, a + u, a + u + v, a + v}) {
    Vertex vertex;
    vertex.position_m = at;
    vertex.normal = normal;
    vertex.tangent = glm::vec4(glm::normalize(u), 1.0f);
    p.vertices.push_back(vertex);
  }
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(first + i);
}

Primitive block(glm::vec3 low, glm::vec3 high) {
  Primitive p;
  const glm::vec3 d = high - low, x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
  add_side(p, low + z, x, y);
  add_side(p, low + x, -x, y);
  add_side(p, low, z, y);
  add_side(p, low + x + z, -z, y);
  add_side(p, low + y + z, x, -z);
  add_side(p, low, x, z);
  p.material = 0;
  p.bounds_min_m = low;
  p.bounds_max_m = high;
  return p;
}

}  // namespace

std::shared_ptr<const Model> shelter_street() {
  auto model = std::make_shared<Model>();
  model->materials.resize(1);
  const auto put = [&](glm::vec3 low, glm::vec3 high) { model->meshes.push_back({"part", {block(low, high)}}); };
  put({-60, -1, -60}, {60, 0, 60});
  put({-2, awning_height_m, -4}, {2, awning_height_m + 0.1f, 4});  // free-standing roof
  for (const float x : {-1.95f, 1.85f})
    for (const float z : {-3.95f, 3.85f}) put({x, 0, z}, {x + 0.1f, awning_height_m, z + 0.1f});
  put({-3, 0, -34}, {3, 7, -20});  // house
  put({3, awning_height_m, -31}, {4.8f, awning_height_m + 0.1f, -23});
  put({-4.8f, awning_height_m, -31}, {-3, awning_height_m + 0.1f, -23});
  put({18, 5, 8}, {26, 5.6f, 50});        // bridge
  put({18, 5.6f, 8}, {18.2f, 6.6f, 50});  // and its parapets
  put({25.8f, 5.6f, 8}, {26, 6.6f, 50});
  put({24, 3.5f, -30}, {28, 8, -10});  // arcade: rooms above, a wall behind, pillars in front
  put({28, 0, -30}, {34, 8, -10});
  for (int i = 0; i <= 5; ++i) {
    const float z = -30.0f + 3.9f * static_cast<float>(i);
    put({24, 0, z}, {24.5f, 3.5f, z + 0.5f});
  }
  return model;
}

std::vector<ShelterQuestion> shelter_places(const std::string& where, float step_m) {
  std::vector<ShelterQuestion> places;
  const auto lattice = [&](glm::vec3 corner, glm::vec3 u, glm::vec3 v, glm::vec3 normal) {
    const int across = std::max(1, static_cast<int>(glm::length(u) / step_m));
    const int up = std::max(1, static_cast<int>(glm::length(v) / step_m));
    for (int j = 0; j < up; ++j)
      for (int i = 0; i < across; ++i) {
        // Off the lattice of the maps' texels: by the golden ratio within each square.
        const float a = std::fmod(0.5f + 0.6180340f * static_cast<float>(j), 1.0f);
        const float b = std::fmod(0.5f + 0.6180340f * static_cast<float>(i), 1.0f);
        places.push_back({corner + u * ((static_cast<float>(i) + a) / static_cast<float>(across)) +
                              v * ((static_cast<float>(j) + b) / static_cast<float>(up)),
                          normal});
      }
  };
  const glm::vec3 level(0, 1, 0);
  if (where == "awning") lattice({-5, 0, -6}, {12, 0, 0}, {0, 0, 12}, level);
  if (where == "house") {
    lattice({-10, 0, -36}, {7, 0, 0}, {0, 0, 18}, level);
    lattice({3, 0, -36}, {9, 0, 0}, {0, 0, 18}, level);
  }
  if (where == "walls") {
    lattice({-3, 0, -34}, {0, 0, 14}, {0, 7, 0}, {-1, 0, 0});
    lattice({3, 0, -34}, {0, 0, 14}, {0, 7, 0}, {1, 0, 0});
  }
  if (where == "bridge") {
    lattice({12, 0, 18}, {22, 0, 0}, {0, 0, 20}, level);
    lattice({18.2f, 5.6f, 18}, {7.6f, 0, 0}, {0, 0, 20}, level);
  }
  if (where == "arcade") lattice({18, 0, -28}, {9.9f, 0, 0}, {0, 0, 16}, level);
  return places;
}

}  // namespace petrichor
