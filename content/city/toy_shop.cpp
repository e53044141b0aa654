#include "content/city/parts.hpp"
namespace petrichor::city {
void add_toy_shop(Scene&) {}
}  // namespace petrichor::city
