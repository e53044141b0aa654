#pragma once
#include <vector>

#include "engine/core/bench_row.hpp"

namespace petrichor {

// What a registry does all day, at 50 thousand and a million entities: walking 2, 3 and 4 components, the
// same with shuffled storages and after sorting them, making entities with 2 components, taking a component
// off and putting it back, destroying. Milliseconds for all n at once. Takes a few seconds.
std::vector<BenchRow> bench_ecs();

}  // namespace petrichor
