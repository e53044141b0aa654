#pragma once
#include <span>

#include "components/light.hpp"
#include "components/reflection.hpp"
#include "components/techniques.hpp"
#include "components/transform.hpp"
#include "components/view.hpp"
#include "components/water.hpp"
#include "components/weather.hpp"
#include "engine/ecs/schema.hpp"

namespace petrichor {

// Every component that scripts, glTF extras, --set and the inspector know.
std::span<const Schema> component_schemas();

}  // namespace petrichor
