#include "content/city/parts.hpp"
namespace petrichor::city {
void add_vehicles(Scene&) {}
}  // namespace petrichor::city
