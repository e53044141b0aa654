#pragma once
// Finds what is worth mirroring in a mesh: lit panels and dark posts. The artist marks nothing: emissive materials
// shine, and what is tall and thin is a post.

#include <vector>

#include "engine/assets/model.hpp"
#include "systems/reflector_frame.hpp"

namespace petrichor {

// In object space; emissive textures are sampled. Parts of one material that touch, or almost do, are one rectangle of
// the same flux, up to 4 m: a neon sign is one reflector, a shop window another. Nothing under 2 cd/m2.
std::vector<Reflector> find_reflectors(const Model&, const Mesh&);
// Whether any of its materials is smooth enough for single things to be seen in it. Roughness textures are sampled.
bool mirrors_things(const Model&, const Mesh&);
Reflector moved(const Reflector&, const glm::mat4&);

}  // namespace petrichor
