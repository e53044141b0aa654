#include "systems/systems.hpp"

#include <iterator>

#include "systems/atmosphere/extract.hpp"
#include "systems/atmosphere/passes.hpp"
#include "systems/drip/drip.hpp"
#include "systems/geometry/extract.hpp"
#include "systems/geometry/passes.hpp"
#include "systems/image/passes.hpp"
#include "systems/lighting/passes.hpp"
#include "systems/mirror/mirror.hpp"
#include "systems/occlusion/chart.hpp"
#include "systems/occlusion/occlusion.hpp"
#include "systems/occlusion/rays.hpp"
#include "systems/occlusion/street.hpp"
#include "systems/puddle/puddle.hpp"
#include "systems/rainfall/chart.hpp"
#include "systems/rainfall/class_chart.hpp"
#include "systems/rainfall/cone/cone.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/ladders.hpp"
#include "systems/rainfall/layered/motion.hpp"
#include "systems/rainfall/near_drops/near.hpp"
#include "systems/rainfall/near_drops/near_chart.hpp"
#include "systems/rainfall/passes.hpp"
#include "systems/rainfall/streaks/chart.hpp"
#include "systems/rainfall/snow/chart.hpp"
#include "systems/rainfall/snow/extract.hpp"
#include "systems/rainfall/sprites/sprites.hpp"
#include "systems/reflection/extract.hpp"
#include "systems/reflection/reflection.hpp"
#include "systems/ripple/ripple.hpp"
#include "systems/scene/propagate.hpp"
#include "systems/splash/splash.hpp"
#include "systems/splatter/splatter.hpp"
#include "systems/walker/walk.hpp"
#include "systems/wetness/chart.hpp"
#include "systems/wetness/wetness.hpp"

namespace petrichor {

// In frame order. Input to propagate run at every tick of the fixed clock, extract once a frame.
std::vector<SystemEntry<SystemContext>> all_systems() {
  return {
      {.name = "walk",
       .phase = Phase::input,
       .reads = {"input"},
       .writes = {"walker", "transform"},
       .needs = {"walker"},
       .run = walk},

      {.name = "timeline",
       .phase = Phase::script,
       .reads = {"time"},
       .changes = {"*"},
       .run = [](SystemContext& c) { c.script_result = c.advance_script(c.time_s); }},

      {.name = "rainfall",
       .phase = Phase::simulate,
       .reads = {"emitter", "wind", "time"},
       .writes = {"rain_motion"},
       .needs = {"emitter"},
       .run = [](SystemContext& c) { simulate_rainfall(c.registry, c.time_s); }},

      {.name = "layered_composite",
       .phase = Phase::simulate,
       .reads = {"emitter", "layered_composite", "rain_motion", "camera", "camera_motion", "time"},
       .writes = {"layered_motion"},
       .needs = {"emitter"},
       .after = {"rainfall"},
       .run = [](SystemContext& c) { simulate_layered(c.registry, c.time_s); }},
      {.name = "sprites",
       .phase = Phase::simulate,
       .reads = {"emitter", "rain_motion", "streak_sprites", "time"},
       .writes = {"sprite_motion"},
       .needs = {"streak_sprites"},
       .after = {"rainfall"},
       .run = [](SystemContext& c) { simulate_sprites(c.registry, c.time_s); }},
      {.name = "snowfall",
       .phase = Phase::simulate,
       .reads = {"snowfall", "wind", "time"},
       .writes = {"snow_motion"},
       .needs = {"snowfall"},
       .run = [](SystemContext& c) { simulate_snowfall(c.registry, c.time_s); }},

      {.name = "drips",
       .phase = Phase::simulate,
       .reads = {"emitter", "wind", "drip_source", "world_transform", "mesh_instance", "time"},
       .writes = {"drip_motion"},
       .needs = {"drip_source"},
       .run = [](SystemContext& c) { simulate_drips(c.registry, c.models, c.time_s, c.step_s); }},
      {.name = "puddles",
       .phase = Phase::simulate,
       .reads = {"emitter", "puddle", "time"},
       .writes = {"puddle_water"},
       .needs = {"puddle"},
       .run = [](SystemContext& c) { simulate_puddles(c.registry, c.time_s, c.step_s); }},
      {.name = "wetness",
       .phase = Phase::simulate,
       .reads = {"emitter", "wind", "time"},
       .writes = {"wetness_history"},
       .needs = {"emitter"},
       .run = [](SystemContext& c) { simulate_wetness(c.registry, c.time_s, c.step_s); }},
      {.name = "ripples",
       .phase = Phase::simulate,
       .reads = {"emitter", "wind", "ripples", "puddle", "wader", "camera", "world_transform", "time"},
       .writes = {"ripple_history"},
       .needs = {"puddle"},
       .after = {"rainfall", "drips"},
       .run = [](SystemContext& c) { simulate_ripples(c.registry, c.time_s, c.step_s); }},

      {.name = "propagate_transforms",
       .phase = Phase::propagate,
       .reads = {"transform"},
       .writes = {"world_transform", "parent"},
       .run = [](SystemContext& c) { propagate_transforms(c.registry); }},
      {.name = "track_cameras",
       .phase = Phase::propagate,
       .reads = {"camera", "world_transform"},
       .writes = {"camera_motion"},
       .needs = {"camera"},
       .after = {"propagate_transforms"},
       .run = [](SystemContext& c) { track_cameras(c.registry); }},
      {.name = "double_cone",
       .phase = Phase::propagate,
       .reads = {"emitter", "snowfall", "double_cone", "rain_motion", "snow_motion", "camera", "camera_motion", "time"},
       .writes = {"cone_motion"},
       .needs = {"emitter", "snowfall"},
       .after = {"track_cameras"},
       .run = [](SystemContext& c) { simulate_cone(c.registry, c.time_s, c.step_s); }},

      {.name = "extract_camera",
       .phase = Phase::extract,
       .reads = {"camera", "camera_motion"},
       .writes = {"frame.camera"},
       .needs = {"camera"},
       .run = [](SystemContext& c) { extract_camera(c.registry, *c.frame, c.interpolation, c.step_s); }},
      {.name = "extract_instances",
       .phase = Phase::extract,
       .reads = {"mesh_instance", "world_transform"},
       .writes = {"frame.instances"},
       .needs = {"mesh_instance"},
       .run = [](SystemContext& c) { extract_instances(c.registry, *c.frame); }},
      {.name = "extract_lights",
       .phase = Phase::extract,
       .reads = {"light", "world_transform"},
       .writes = {"frame.lights"},
       .needs = {"light"},
       .run = [](SystemContext& c) { extract_lights(c.registry, *c.frame); }},
      {.name = "extract_atmosphere",
       .phase = Phase::extract,
       .reads = {"sky", "fog"},
       .writes = {"frame.sky", "frame.mist"},
       .needs = {"sky", "fog"},
       .run = [](SystemContext& c) { extract_atmosphere(c.registry, *c.frame); }},
      {.name = "extract_wind",
       .phase = Phase::extract,
       .reads = {"wind"},
       .writes = {"frame.wind"},
       .needs = {"wind"},
       .run = [](SystemContext& c) { extract_wind(c.registry, *c.frame); }},
      {.name = "extract_rainfall",
       .phase = Phase::extract,
       .reads = {"emitter", "rain_motion", "frame.camera"},
       .writes = {"frame.rain"},
       .needs = {"emitter"},
       .after = {"extract_camera"},
       .run = [](SystemContext& c) { extract_rainfall(c.registry, *c.frame, c.time_s); }},
      {.name = "extract_layered",
       .phase = Phase::extract,
       .reads = {"emitter", "layered_composite", "layered_motion", "frame.camera", "frame.rain"},
       .writes = {"frame.rain.layered"},
       .needs = {"emitter"},
       .after = {"extract_rainfall"},
       .run = [](SystemContext& c) { extract_layered(c.registry, *c.frame, c.time_s, c.interpolation); }},
      {.name = "extract_sprites",
       .phase = Phase::extract,
       .reads = {"emitter", "streak_sprites", "sprite_motion", "frame.rain"},
       .writes = {"frame.rain.sprites"},
       .needs = {"emitter"},
       .after = {"extract_rainfall"},
       .run = [](SystemContext& c) { extract_sprites(c.registry, *c.frame, c.time_s); }},
      {.name = "extract_near_drops",
       .phase = Phase::extract,
       .reads = {"emitter", "near_drops", "frame.rain"},
       .writes = {"frame.rain.near_drops"},
       .needs = {"emitter"},
       .after = {"extract_rainfall"},
       .run = [](SystemContext& c) { extract_near_drops(c.registry, *c.frame); }},
      {.name = "extract_snowfall",
       .phase = Phase::extract,
       .reads = {"snowfall", "snow_motion", "frame.camera"},
       .writes = {"frame.snow"},
       .needs = {"snowfall"},
       .after = {"extract_camera"},
       .run = [](SystemContext& c) { extract_snowfall(c.registry, *c.frame, c.time_s); }},
      {.name = "extract_cone",
       .phase = Phase::extract,
       .reads = {"double_cone", "cone_motion", "frame.camera", "frame.rain", "frame.snow"},
       .writes = {"frame.rain.cone", "frame.snow.cone"},
       .needs = {"emitter", "snowfall"},
       .after = {"extract_rainfall", "extract_snowfall"},
       .run = [](SystemContext& c) { extract_cone(c.registry, *c.frame, c.time_s); }},

      // Where the rain lands.
      {.name = "extract_drips",
       .phase = Phase::extract,
       .reads = {"drip_source", "drip_motion", "frame.camera"},
       .writes = {"frame.drips"},
       .needs = {"drip_source"},
       .after = {"extract_camera"},
       .run = [](SystemContext& c) { extract_drips(c.registry, *c.frame, c.time_s); }},
      {.name = "extract_splashes",
       .phase = Phase::extract,
       .reads = {"emitter", "splashes", "frame.camera", "frame.instances", "frame.lights", "frame.rain", "frame.drips"},
       .writes = {"frame.splashes"},
       .needs = {"emitter"},
       .after = {"extract_instances", "extract_lights", "extract_rainfall", "extract_drips"},
       .run = [](SystemContext& c) { extract_splashes(c.registry, *c.frame, c.models); }},
      {.name = "extract_splatter",
       .phase = Phase::extract,
       .reads = {"rain_catcher", "mesh_instance", "parent", "frame.instances", "frame.rain"},
       .writes = {"frame.splatter"},
       .needs = {"rain_catcher"},
       .after = {"extract_instances", "extract_rainfall"},
       .run = [](SystemContext& c) { extract_splatter(c.registry, c.models, *c.frame); }},
      {.name = "extract_puddles",
       .phase = Phase::extract,
       .reads = {"puddle", "puddle_water", "world_transform", "frame.camera"},
       .writes = {"frame.puddles"},
       .needs = {"puddle"},
       .after = {"extract_camera"},
       .run = [](SystemContext& c) { extract_puddles(c.registry, *c.frame); }},
      {.name = "extract_wetness",
       .phase = Phase::extract,
       .reads = {"emitter", "wetness_history"},
       .writes = {"frame.wetness"},
       .needs = {"emitter"},
       .run = [](SystemContext& c) { extract_wetness(c.registry, *c.frame, c.time_s); }},
      {.name = "extract_ripples",
       .phase = Phase::extract,
       .reads = {"emitter", "ripple_history", "frame.camera", "frame.rain", "frame.drips", "frame.puddles"},
       .writes = {"frame.ripples"},
       .needs = {"puddle"},
       .after = {"extract_rainfall", "extract_drips", "extract_puddles"},
       .run = [](SystemContext& c) { extract_ripples(c.registry, *c.frame, c.time_s); }},
      {.name = "extract_reflectors",
       .phase = Phase::extract,
       .reads = {"frame.instances", "frame.rain", "frame.puddles", "frame.wetness"},
       .writes = {"frame.reflectors"},
       .needs = {"mesh_instance"},
       .after = {"extract_instances", "extract_rainfall", "extract_puddles", "extract_wetness"},
       .run = [finder = std::make_shared<ReflectorFinder>()](SystemContext& c) {
         extract_reflectors(*finder, c.models, *c.frame);
       }},
      {.name = "extract_mirrors",
       .phase = Phase::extract,
       .reads = {"frame.camera", "frame.rain", "frame.puddles", "glass_pane", "reflection_probe", "mesh_instance", "parent",
                 "world_transform"},
       .writes = {"frame.mirrors"},
       .after = {"extract_camera", "extract_rainfall", "extract_puddles"},
       .run = [](SystemContext& c) { extract_mirrors(c.registry, *c.frame); }},
  };
}

std::vector<std::string_view> outside_resources() {
  return {"time", "input"};
}

std::vector<PassOffer> all_passes() {
  std::vector<PassOffer> all;
  const DropPainting painting;
  for (std::vector<PassOffer> some :
       {geometry_passes(), occlusion_passes(), lighting_passes(), atmosphere_passes(), rainfall_passes(painting),
        splash_passes(painting), splatter_passes(painting), drip_passes(painting), ripple_passes(), puddle_passes(),
        wetness_passes(), reflection_passes(), mirror_passes(), image_passes()})
    all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
  return all;
}

std::vector<Ladder> all_ladders() {
  std::vector<Ladder> all;
  all.push_back(rainfall_ladder());
  all.push_back(snow_ladder());
  all.push_back(streaks_ladder());
  all.push_back(near_drops_ladder());
  all.push_back(occlusion_ladder());
  all.push_back(splashes_ladder());
  all.push_back(splatter_ladder());
  all.push_back(halos_ladder());
  all.push_back(drips_ladder());
  all.push_back(ripples_ladder());
  all.push_back(puddles_ladder());
  all.push_back(wetness_ladder());
  all.push_back(reflections_ladder());
  all.push_back(probes_ladder());
  all.push_back(antialias_ladder());
  all.push_back(resolution_ladder());
  return all;
}

namespace {

FrameRain rain_of_emitter(const Emitter& emitter, const Wind& wind, double time_s) {
  return make_frame_rain(emitter, start_rain_motion(emitter, wind), {}, 1, 1, time_s);
}

Result<void> chart_shelter(const ChartRun& run) {
  return chart_occlusion(run, rain_of_emitter);
}

Result<void> chart_wet(const ChartRun& run) {
  WetTruth truth;
  truth.passes = all_passes();
  truth.street = shelter_street();
  truth.rays = [](std::span<const Model* const> models, std::span<const FrameInstance> instances) {
    auto rays = std::make_shared<ShelterRays>(models, instances);
    return WetTruth::Sheltered([rays](const glm::vec3& place_m, const glm::vec3& velocity_mps) {
      return rays->sheltered(place_m, velocity_mps);
    });
  };
  return chart_wetness(run, truth);
}

}  // namespace

std::vector<ChartOffer> all_charts() {
  return {
      {"rainfall", "all ways to draw falling rain, in three scenes", chart_rainfall},
      {"snow", "ways to draw falling snow, light and heavy", chart_snow},
      {"classes", "how many size classes of drops are enough", chart_classes},
      {"occlusion", "maps of shelter against rays, on a street of awnings and in the town", chart_shelter},
      {"streaks", "size of the streak table against its error, and what nearest-four reading costs", chart_streaks},
      {"splashes", "splashes of the rain, against every impact",
       [](const ChartRun& run) { return chart_splashes(run, rain_of_emitter); }},
      {"halos", "mist of splashes along outlines, by fins and by a thin layer", chart_halos},
      {"drips", "drops that fall from edges", chart_drips},
      {"ripples", "rings on water, against the spectral solution", chart_ripples},
      {"puddles", "standing water, against a fine balance", chart_puddles},
      {"wetness", "films of water on surfaces, against rays", chart_wet},
      {"reflections", "what wet ground mirrors, against rays",
       [](const ChartRun& run) { return chart_reflections(run, all_passes); }},
      {"mirrors", "still water and panes as planar mirrors, against rays",
       [](const ChartRun& run) { return chart_mirrors(run, all_passes()); }},
      {"probes", "what moving cars mirror, against rays",
       [](const ChartRun& run) { return chart_probes(run, all_passes()); }},
      {"near_drops", "drops near the eye, by maps and by closed form, against traced ones", chart_near_drops},
  };
}

}  // namespace petrichor
