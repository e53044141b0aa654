#pragma once
// A camera for a model that brings none.

#include "components/transform.hpp"
#include "components/view.hpp"
#include "engine/assets/model.hpp"

namespace petrichor {

struct FramingCamera {
  Transform transform;
  Camera camera;  // active, with a near distance that cuts nothing off
};

// Sees all of the model's bounds from the front, to the right and slightly above (glTF's front is +z), as
// close as a picture of the given width / height allows. An empty model is looked at as a 2 m cube.
FramingCamera framing_camera(const Model&, float aspect = 16.0f / 9.0f);

}  // namespace petrichor
