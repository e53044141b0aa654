#pragma once
// The Frame: everything the passes draw, as flat arrays. Systems fill it in the extract phase; passes read
// it and never the registry. Plain values: a Frame could be saved and drawn again.

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "components/weather.hpp"
#include "systems/frame_shared.h"
#include "systems/rain_frame.hpp"
#include "systems/snow_frame.hpp"
#include "systems/techniques.hpp"

namespace petrichor {

struct GpuScene;  // systems/gpu_scene.hpp: meshes, materials and textures on the GPU

// Where the rain lands: each in its own header, systems/<name>_frame.hpp, filled by the system of that name.
struct FrameSplashes;
struct FrameSplatter;
struct FrameDrips;
struct FrameRipples;
struct FramePuddles;
struct FrameWetness;
struct FrameMirrors;
struct FrameReflectors;

struct FrameCamera {
  glm::dvec3 position_m{0.0};  // world
  glm::quat orientation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec3 velocity_mps{0.0f};
  glm::vec3 angular_velocity_radps{0.0f};  // world axes
  float vertical_fov_rad = 1.0f;
  float near_m = 0.05f;
  float exposure_s = 1.0f / 60.0f;
  float exposure_ev100 = 3.0f;
  float bloom = 0.06f;
};

struct FrameInstance {
  std::uint32_t model;
  std::uint32_t mesh;
  bool casts_shadow;
  glm::mat4 matrix;  // object -> world
  std::uint32_t entity = 0;  // entity_index of where it comes from, for systems that mark instances
};

struct FrameLight {
  glm::vec3 position_m;  // world
  glm::vec3 direction;   // unit, the way it shines
  glm::vec3 intensity;   // cd (lux where directional), rgb
  float range_m;         // 0: none given
  float inner_cone_rad, outer_cone_rad;
  float source_radius_m;
  int kind;  // LIGHT_*
  bool casts_shadow, lights_rain;
  int shadow_slot = -1;  // in the shadow maps; set by whoever draws them before the lights are uploaded
};

struct FrameMist {
  float extinction_per_m = 0.0f;
  glm::vec3 albedo{0.96f};
};

struct FrameSky {
  glm::vec3 zenith_cd_m2{0.0f};
  glm::vec3 horizon_cd_m2{0.0f};
  float glow_height = 0.25f;
  float ambient = 1.0f;
};

struct Frame {
  std::uint64_t number = 0;
  double time_s = 0.0;
  float step_s = 1.0f / 60.0f;  // since the frame before; only published settings may depend on it
  Techniques techniques;        // before the systems extract: by what each effect is drawn
  int width = 0, height = 0;  // pixels of the output image
  FrameCamera camera;
  FrameSky sky;
  FrameMist mist;
  std::vector<FrameInstance> instances;
  std::vector<FrameLight> lights;
  // Changes whenever an instance (or its matrix) or a shadow-casting light changes: cached maps compare it.
  std::uint64_t geometry_version = 0;
  std::uint64_t lights_version = 0;
  std::optional<FrameRain> rain;            // absent, or its rate 0: no rain pass runs
  std::optional<Wind> wind;                 // as the scene says; absent: only what the rain and snow know of it
  std::optional<FrameSnow> snow;            // absent, or its rate 0: no snow pass runs
  // Absent: there is none of it in the scene, and its passes do not run.
  std::shared_ptr<const FrameSplashes> splashes;
  std::shared_ptr<const FrameSplatter> splatter;
  std::shared_ptr<const FrameDrips> drips;
  std::shared_ptr<const FrameRipples> ripples;
  std::shared_ptr<const FramePuddles> puddles;
  std::shared_ptr<const FrameWetness> wetness;
  std::shared_ptr<const FrameMirrors> mirrors;
  std::shared_ptr<const FrameReflectors> reflectors;
  std::int32_t affordable_drops = 4000000;  // for an emitter that names no budget of its own
  GpuScene* scene = nullptr;
  FrameUniforms uniforms{};  // filled last, by finish_frame (systems/frame_gpu.hpp)
};

}  // namespace petrichor
