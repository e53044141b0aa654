#pragma once
// From meshes to the frame's reflectors.

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "engine/assets/model.hpp"
#include "systems/frame.hpp"
#include "systems/reflector_frame.hpp"

namespace petrichor {

// What was found, kept while nothing moves. No picture depends on when.
struct ReflectorFinder {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Reflector>> of_mesh;  // by model and mesh
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> mirrors;  // whether a mesh is smooth enough to mirror
  std::size_t models = 0;
  bool any_mirrors = false;
  std::uint64_t geometry_version = 0;
  std::shared_ptr<const FrameReflectors> placed;
};

// Fills frame.reflectors from frame.instances; leaves it empty where no rung of the frame asks for it and where nothing
// mirrors: all dry, and no material smoother than `mirror_share` (streak.h) asks for.
void extract_reflectors(ReflectorFinder&, const std::vector<std::shared_ptr<const Model>>&, Frame&);

}  // namespace petrichor
