#pragma once
// The tiling textures of the city's surfaces, dry.

#include "content/city/canvas.hpp"
#include "content/city/scene.hpp"

namespace petrichor::city {

Maps asphalt_maps();  // one lane of 5 m, u from the middle of the road to the kerb, v along it
Maps setts_maps();
Maps slabs_maps();
Maps brick_maps();
Maps stucco_maps();
Maps ashlar_maps();
Maps tile_maps();
Maps marking_maps();
Maps ironwork_maps();

}  // namespace petrichor::city
