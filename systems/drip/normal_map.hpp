#pragma once
// The droplet that billboards show: its normals, made here.

#include "engine/gpu/objects.hpp"

namespace petrichor {

// DRIP_NORMALS texels a side, rgba8, all levels: normal's x and y (0.5 is 0), height, opacity. A sphere's normals, a
// little pear-shaped. Each further level is the one before, blurred and stretched along the fall (Tatarchuk and Isidoro
// 2006, section 3.2: "a pre-blurred and a priori stretched normal map"), so that a bias of the level blurs motion.
Texture make_droplet_normals();

}  // namespace petrichor
