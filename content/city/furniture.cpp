#include "content/city/furniture.hpp"

namespace petrichor::city {

void add_furniture(Scene& scene) {
  add_lamps(scene);
}

}  // namespace petrichor::city
