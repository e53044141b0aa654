// Skinned meshes in the pose of their file (specification 2.0, section 3.7.3): vertices are moved once, at
// load, to where the joints stand.

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/assets/gltf_accessor.hpp"

namespace petrichor {
namespace {

struct Influences {
  AccessorView joints, weights;
};

AccessorView open_vec4(Document& document, int accessor, std::uint64_t count, const std::string& path) {
  AccessorView view = open_accessor(document, accessor);
  if (view.components != 4 || view.count != count) {
    gltf_fail(path, fmt::format("{} has {} elements of {} components, POSITION asks for {} of 4", view.path, view.count,
                                view.components, count));
  }
  return view;
}

// JOINTS_0 and WEIGHTS_0, and further sets of four while there are any.
std::vector<Influences> open_influences(Document& document, const tinygltf::Primitive& source,
                                        const std::string& path) {
  std::vector<Influences> out;
  const std::uint64_t count = open_accessor(document, source.attributes.at("POSITION")).count;
  for (int set = 0;; ++set) {
    const std::string joints_name = fmt::format("JOINTS_{}", set), weights_name = fmt::format("WEIGHTS_{}", set);
    const auto joints = source.attributes.find(joints_name), weights = source.attributes.find(weights_name);
    if (joints == source.attributes.end() || weights == source.attributes.end()) return out;
    Influences one{open_vec4(document, joints->second, count, fmt::format("{}/attributes/{}", path, joints_name)),
                   open_vec4(document, weights->second, count, fmt::format("{}/attributes/{}", path, weights_name))};
    if (one.joints.component_type != ComponentType::uint8 && one.joints.component_type != ComponentType::uint16) {
      gltf_fail(one.joints.path + "/componentType", "holds joints: 5121 or 5123 is needed");
    }
    out.push_back(std::move(one));
  }
}

}  // namespace

SkinPose pose_of_skin(Document& document, int skin, const std::function<glm::dmat4(std::size_t)>& world_of_node) {
  const nlohmann::json& source = (*document.json)["skins"][static_cast<std::size_t>(skin)];
  const std::string path = fmt::format("/skins/{}", skin);
  const auto& joints = source["joints"];
  SkinPose pose;
  pose.skin = skin;
  AccessorView inverse_bind;
  if (source.contains("inverseBindMatrices")) {
    inverse_bind = open_accessor(document, source["inverseBindMatrices"].get<int>());
    if (inverse_bind.components != 16 || inverse_bind.component_type != ComponentType::float32 ||
        inverse_bind.count < joints.size()) {
      gltf_fail(path + "/inverseBindMatrices",
                fmt::format("{} holds no {} 4x4 matrices of floats", inverse_bind.path, joints.size()));
    }
  }
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const glm::dmat4 bind(inverse_bind.count > 0 ? read_matrix(inverse_bind, i) : glm::mat4(1.0f));
    pose.joints.push_back(world_of_node(joints[i].get<std::size_t>()) * bind);
  }
  return pose;
}

void apply_pose(Document& document, const tinygltf::Primitive& source, const std::vector<std::uint32_t>& used,
                const SkinPose& pose, Primitive& out, const std::string& path) {
  const auto influences = open_influences(document, source, path);
  for (std::size_t i = 0; i < used.size(); ++i) {
    glm::dmat4 blend(0.0);
    double total = 0.0;
    for (const Influences& set : influences) {
      const glm::vec4 weights = read_vector(set.weights, used[i]);
      for (int k = 0; k < 4; ++k) {
        if (!(weights[k] > 0.0f)) continue;
        const std::uint32_t joint = read_unsigned(set.joints, used[i], k);
        if (joint >= pose.joints.size()) {
          gltf_fail(set.joints.path, fmt::format("element {} names joint {}, /skins/{} has {}", used[i], joint,
                                                 pose.skin, pose.joints.size()));
        }
        blend += pose.joints[joint] * static_cast<double>(weights[k]);
        total += weights[k];
      }
    }
    if (!(total > 0.0)) continue;
    blend /= total;
    Vertex& v = out.vertices[i];
    const glm::dmat3 linear(blend);
    // Normals follow the cofactors: the inverse transpose up to a factor, and defined for flat poses too.
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    const glm::dvec3 normal = cofactors * glm::dvec3(v.normal), tangent = linear * glm::dvec3(v.tangent);
    const glm::dvec3 position(blend * glm::dvec4(glm::dvec3(v.position_m), 1.0));
    if (!(glm::length(position) <= largest_position_m)) {
      gltf_fail(path, fmt::format("vertex {} is posed {} from the origin, at most {} is read", used[i],
                                  glm::length(position), largest_position_m));
    }
    v.position_m = position;
    const auto unit = [](glm::dvec3 w) {
      return glm::length(w) > 1e-30 ? glm::vec3(glm::normalize(w)) : glm::vec3(0.0f);
    };
    v.normal = unit(normal);
    v.tangent = glm::vec4(unit(tangent), v.tangent.w);
  }
}

}  // namespace petrichor
