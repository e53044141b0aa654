#pragma once
// A compute shader that a render script brings along, as a pass like any other.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/graph/graph.hpp"

namespace petrichor {

struct ArtistPass {
  std::string id;
  std::string file;
  std::vector<std::string> samplers;                    // uniform names, each also the name of a read slot
  std::vector<std::string> images;                      // likewise, of write and modify slots
  std::map<std::string, std::vector<double>> uniforms;  // 1 to 4 numbers each
};

// Slots are left empty: the table knows them. Runs one invocation per pixel of the largest image; sets `ivec2 u_size`
// to that size where the shader has it, and samplers and images to units of its own choice.
std::shared_ptr<PassOffer> make_artist_offer(ArtistPass);

// After the shader has compiled: names that cannot work are errors, names that the shader does not use a warning.
Result<void> check_artist_program(const ArtistPass&, const Program&);

}  // namespace petrichor
