#pragma once
// What stands in the street.

#include "content/city/parts.hpp"

namespace petrichor::city {

void add_lamps(Scene&);
void add_signals(Scene&);
void add_wires(Scene&);
void add_bus_shelter(Scene&);
void add_small_things(Scene&);  // benches, bins, bollards, planters, pillar box, kiosk
void add_wall_signs(Scene&);    // neon blades, street names
void add_street_ends(Scene&);   // the gate's passage, the church

}  // namespace petrichor::city
