#pragma once
// Planar mirrors and moving probes of one frame. Filled by systems/mirror; pass `mirrors` (systems/mirror) draws the
// planes, pass `probes` (systems/lighting, which has the machinery of captures) the probes.

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace petrichor {

struct FrameMirrors {
  // A plane that the frame may mirror, seen from its shining side.
  struct Plane {
    glm::vec3 normal{0.0f, 1.0f, 0.0f};  // unit, towards the eye
    float eye_m = 0.0f;                  // distance of the eye from it, > 0
    // What of the picture may show its mirror image: from low to high in -1..1 (normalised device coordinates).
    glm::vec2 low{-1.0f}, high{1.0f};
    float share = 1.0f;        // how sure it is that this is the plane to mirror; falls to 0 where another is as large
    float tolerance_m = 0.1f;  // surfaces so far off it mirror nothing of it
    float coverage = 0.0f;     // share of the picture that lies on it
  };
  // A cube map about an object.
  struct Probe {
    glm::dvec3 place_m{0.0};   // world, the middle of the object
    float radius_m = 3.0f;     // surfaces within it mirror this probe
    float share = 1.0f;        // falls to 0 where a nearer object is about to take its place
    float coverage = 0.0f;     // share of the picture that its sphere covers; 0: out of view, and nothing is captured
    std::uint32_t entity = 0;  // entity_index
    std::vector<std::uint32_t> own;  // entities of its instances, ascending: it does not see itself
  };
  std::optional<Plane> water, pane;  // layers 0 and 1 of resource `mirrors`
  std::vector<Probe> probes;         // the nearest PROBES, by distance (systems/mirror_shared.h)
};

}  // namespace petrichor
