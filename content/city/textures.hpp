#pragma once
// The tiling textures of the city's surfaces, under a thin film of rain: albedos halve and roughness falls
// (shared physics, section 9). `wet` = false gives the same surfaces dry.

#include "content/city/canvas.hpp"
#include "content/city/scene.hpp"

namespace petrichor::city {

Maps asphalt_maps(bool wet);  // one lane of 5 m, u from the middle of the road to the kerb, v along it
Maps setts_maps(bool wet);
Maps slabs_maps(bool wet);
Maps brick_maps(bool wet);
Maps stucco_maps(bool wet);
Maps ashlar_maps(bool wet);
Maps tile_maps(bool wet);
Maps marking_maps(bool wet);
Maps ironwork_maps(bool wet);

}  // namespace petrichor::city
