#include "content/city/furniture.hpp"

namespace petrichor::city {

void add_furniture(Scene& scene) {
  add_lamps(scene);
  add_signals(scene);
  add_wires(scene);
  add_bus_shelter(scene);
  add_small_things(scene);
  add_wall_signs(scene);
  add_street_ends(scene);
}

}  // namespace petrichor::city
