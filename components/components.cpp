#include "components/components.hpp"

#include <array>

namespace petrichor {
namespace {

using std::string_view;
constexpr std::array<string_view, 2> drop_sizes{"marshall_palmer", "gamma"};
constexpr std::array<string_view, 5> cone_textures{"automatic", "drizzle", "rain", "snow_fine", "snow_coarse"};
constexpr std::array<string_view, 2> puddle_shapes{"bowl", "tub"};
constexpr std::array<string_view, 3> light_kinds{"point", "spot", "directional"};
constexpr Range any{};
constexpr Range positive{0.0, 1e9};

std::vector<Schema> make_schemas() {
  return {
      schema<Name>("name", "What people call the entity.", {field<&Name::text>("text", "", any, "The name.")}),
      schema<Transform>("transform", "Placement relative to the parent, or to the world without one.",
                        {field<&Transform::position_m>("position_m", "m", {-1e7, 1e7}, "Position; y is up."),
                         field<&Transform::orientation>("orientation", "", {-1, 1}, "Unit quaternion x, y, z, w."),
                         field<&Transform::scale>("scale", "", {-1e6, 1e6}, "Scale along the own axes.")}),
      schema<Camera>(
          "camera", "A camera looking along its -z.",
          {field<&Camera::vertical_fov_deg>("vertical_fov_deg", "deg", {1, 170}, "Vertical field of view."),
           field<&Camera::near_m>("near_m", "m", {0.001, 100}, "Nearest distance drawn."),
           field<&Camera::exposure_s>("exposure_s", "s", {1e-5, 1}, "Shutter time that streaks are integrated over."),
           field<&Camera::exposure_ev100>("exposure_ev100", "EV", {-10, 20},
                                          "Exposure value: +1 halves the brightness."),
           field<&Camera::bloom>("bloom", "", {0, 1}, "Share of the light that the lens scatters."),
           field<&Camera::active>("active", "", any, "The first active camera makes the picture.")}),
      schema<Light>(
          "light", "A punctual light (KHR_lights_punctual), shining along its -z.",
          {field<&Light::kind>("kind", "", any, "Shape of the light.", light_kinds),
           colour<&Light::colour>("colour", "", {0, 1000}, "Linear RGB, multiplies the intensity."),
           field<&Light::intensity_cd>("intensity_cd", "cd", {0, 1e9}, "Luminous intensity (lux where directional)."),
           field<&Light::range_m>("range_m", "m", {0, 1e6}, "Distance at which it ends; 0 for no end."),
           field<&Light::inner_cone_deg>("inner_cone_deg", "deg", {0, 90}, "Half angle of full intensity."),
           field<&Light::outer_cone_deg>("outer_cone_deg", "deg", {0, 90}, "Half angle of no intensity."),
           field<&Light::source_radius_m>("source_radius_m", "m", {0, 10}, "Size of the source; softens its shadows."),
           field<&Light::casts_shadow>("casts_shadow", "", any, "Whether it casts shadows."),
           field<&Light::lights_rain>("lights_rain", "", any, "Whether falling drops catch its light.")}),
      schema<Emitter>(
          "emitter", "Falling rain.",
          {field<&Emitter::rain_mm_per_hour>("rain_mm_per_hour", "mm/h", {0, 300}, "Water reaching the ground."),
           field<&Emitter::drop_sizes>("drop_sizes", "", any, "Distribution of drop diameters.", drop_sizes),
           field<&Emitter::gamma_shape>("gamma_shape", "", {-1, 6}, "Shape of the gamma distribution."),
           field<&Emitter::minimum_diameter_mm>("minimum_diameter_mm", "mm", {0.1, 6}, "Smallest drop drawn singly."),
           field<&Emitter::maximum_diameter_mm>("maximum_diameter_mm", "mm", {0.2, 8}, "Largest drop."),
           field<&Emitter::drawn_distance_m>("drawn_distance_m", "m", {0, 500},
                                             "Farther drops become extinction and airlight."),
           field<&Emitter::maximum_drops>(
               "maximum_drops", "", {0, 400000000},
               "Budget of drops, to which the drawn distance shrinks; 0: what the device affords."),
           field<&Emitter::seed>("seed", "", {0, 4294967295.0}, "Which rain of all possible rains.")}),
      schema<DoubleCone>(
          "double_cone", "Settings of the technique rainfall=double_cone (Wang and Wade 2004); every emitter has them.",
          {field<&DoubleCone::published>("published", "", any, "As printed, with what is known to break."),
           field<&DoubleCone::camera_damping>("camera_damping", "", {0, 2},
                                              "C_f: how much the camera's own speed tilts the rain; 1 is true."),
           field<&DoubleCone::parallax>("parallax", "", {0, 10},
                                        "S_f: how much farther each layer looks than the first; 1 is true."),
           field<&DoubleCone::scroll_speed>("scroll_speed", "", {0, 10}, "Speed of the scroll; 1 is true."),
           field<&DoubleCone::streak_length>("streak_length", "", {0, 10}, "S_streak: length of streaks; 1 is true."),
           field<&DoubleCone::texture>("texture", "", any, "Which texture; automatic goes by the rate.", cone_textures)}),
      schema<LayeredComposite>(
          "layered_composite",
          "Settings of the technique rainfall=composite (Tatarchuk and Isidoro 2006); every emitter has them.",
          {field<&LayeredComposite::published>("published", "", any, "As printed, with what is known to break."),
           field<&LayeredComposite::direction>("direction", "m/s", {-80, 80}, "Added to the rain's own velocity."),
           field<&LayeredComposite::speed>("speed", "", {0, 10}, "Multiplies the rain's velocity; 1 is true."),
           field<&LayeredComposite::strength>("strength", "", {0, 10}, "Multiplies the drops' opacity; 1 is true."),
           field<&LayeredComposite::milk>("milk", "", {0, 1}, "Bias of the drops towards white; 0 is true."),
           field<&LayeredComposite::parallax>("parallax", "", {0.1, 10}, "p_r, spread of the published layers' depths."),
           field<&LayeredComposite::rain_contrast>("rain_contrast", "", {0, 10}, "k_c: how much lightning does to drops."),
           field<&LayeredComposite::lightning_1>("lightning_1", "", {0, 100}, "L_1: brightness of a flash, for scripts."),
           field<&LayeredComposite::lightning_2>("lightning_2", "", {0, 100}, "L_2: brightness of another flash.")}),
      schema<StreakSprites>(
          "streak_sprites", "Settings of the technique rainfall=sprites (Tariq 2007); every emitter has them.",
          {field<&StreakSprites::published>("published", "", any, "As printed, with what is known to break."),
           field<&StreakSprites::freeze>("freeze", "", any, "The drops stand still."),
           field<&StreakSprites::hide_rain>("hide_rain", "", any, "The drops are not drawn."),
           field<&StreakSprites::hide_background>("hide_background", "", any, "Only the drops are drawn."),
           field<&StreakSprites::simple_shader>("simple_shader", "", any, "Even streaks, without the table."),
           field<&StreakSprites::fraction>("fraction", "", {0, 1}, "Share of the drops that is drawn."),
           field<&StreakSprites::wind>("wind", "", {0, 10}, "Multiplies the wind; 1 is true."),
           field<&StreakSprites::directional_response>("directional_response", "", {0, 100},
                                                       "Multiplies the light of directional lights; 1 is true."),
           field<&StreakSprites::lamp_response>("lamp_response", "", {0, 100},
                                                "Multiplies the light of point and spot lights; 1 is true.")}),
      schema<NearDrops>(
          "near_drops", "Settings of the technique rainfall=near_drops (Rana); every emitter has them.",
          {field<&NearDrops::published>("published", "", any, "As printed, with what is known to be wrong."),
           field<&NearDrops::least_width_px>("least_width_px", "px", {0.1, 100},
                                             "Drops whose image is at least this wide show the world."),
           field<&NearDrops::most_drops>("most_drops", "", {1, 200000}, "In view, on average; wider ones only if more."),
           field<&NearDrops::step_m>("step_m", "m", {0.05, 100}, "Way of the camera between captures of the world."),
           field<&NearDrops::map_cells>("map_cells", "", {2, 64}, "Cells of maps along a side of 10 m."),
           field<&NearDrops::map_pixels>("map_pixels", "", {4, 64}, "Pixels along a side of a map.")}),
      schema<Snowfall>(
          "snowfall", "Falling snow.",
          {field<&Snowfall::snow_mm_per_hour>("snow_mm_per_hour", "mm/h", {0, 30}, "Water reaching the ground as snow."),
           field<&Snowfall::drawn_distance_m>("drawn_distance_m", "m", {0, 200}, "Farther flakes become haze."),
           field<&Snowfall::maximum_flakes>("maximum_flakes", "", {0, 400000000},
                                            "Budget of flakes; 0: what the device affords."),
           field<&Snowfall::sway>("sway", "", {0, 10}, "Multiplies the flakes' sway; 1 is natural."),
           field<&Snowfall::cone_jitter>("cone_jitter", "", {0, 10},
                                         "Of snow=double_cone: multiplies its textures' sway; 0 is as printed."),
           field<&Snowfall::seed>("seed", "", {0, 4294967295.0}, "Which snow of all possible snows.")}),
      schema<Wind>("wind", "Mean wind and gusts.",
                   {field<&Wind::velocity_mps>("velocity_mps", "m/s", {-80, 80}, "Mean wind."),
                    field<&Wind::gust_mps>("gust_mps", "m/s", {0, 40}, "Gust amplitude along the wind."),
                    field<&Wind::gust_period_s>("gust_period_s", "s", {0.1, 600}, "Period of the slowest gust."),
                    field<&Wind::swirl_mps>("swirl_mps", "m/s", {0, 40}, "Gust amplitude across the wind.")}),
      schema<Fog>("fog", "Mist, besides the rain's own extinction.",
                  {field<&Fog::extinction_per_km>("extinction_per_km", "1/km", {0, 1000}, "Extinction coefficient."),
                   colour<&Fog::albedo>("albedo", "", {0, 1}, "Share of the extinguished light that is scattered.")}),
      schema<Sky>(
          "sky", "The night sky.",
          {colour<&Sky::zenith_cd_m2>("zenith_cd_m2", "cd/m2", positive, "Luminance overhead."),
           colour<&Sky::horizon_cd_m2>("horizon_cd_m2", "cd/m2", positive,
                                       "Luminance of the city's glow at the horizon."),
           field<&Sky::glow_height>("glow_height", "", {0.01, 1}, "Sine of the elevation where the glow falls to 1/e."),
           field<&Sky::ambient>("ambient", "", {0, 100}, "Multiplies the sky's light on surfaces.")}),
      schema<DripSource>(
          "drip_source", "An edge that water drips from, along its +x.",
          {field<&DripSource::length_m>("length_m", "m", {0.01, 1000}, "Length of the edge."),
           field<&DripSource::catchment_depth_m>("catchment_depth_m", "m", {0, 100}, "Depth of the surface behind it."),
           field<&DripSource::lip_radius_mm>("lip_radius_mm", "mm", {0.1, 10}, "Radius of the lip drops hang from."),
           field<&DripSource::edge_share>("edge_share", "", {0, 1},
                                          "Of the catchment's water that comes over the edge; the rest is piped away."),
           field<&DripSource::runoff_s>("runoff_s", "s", {0, 3600}, "Time constant of the water on the catchment."),
           field<&DripSource::site_spacing_mm>("site_spacing_mm", "mm", {2, 10000}, "From one hanging drop to the next."),
           field<&DripSource::jitter>("jitter", "", {0, 0.9}, "Of the time between drops, either way."),
           field<&DripSource::wind>("wind", "", {0, 10}, "Multiplies the wind on its drops."),
           field<&DripSource::elongation>("elongation", "", {0, 10}, "Of billboards: multiplies their stretch by motion."),
           field<&DripSource::opacity>("opacity", "", {0, 1}, "Of billboards: alpha of section 3.2."),
           field<&DripSource::edge_strength>("edge_strength", "", {0, 10}, "Of billboards: e_s of section 3.2."),
           field<&DripSource::edge_bias>("edge_bias", "", {0, 10}, "Of billboards: e_b of section 3.2."),
           field<&DripSource::published>("published", "", any,
                                         "Billboards: opacity by distance and lightning as printed.")}),
      schema<Puddle>(
          "puddle", "A hollow where water stands: a rectangle in x and z at its brim.",
          {field<&Puddle::size_m>("size_m", "m", {0.01, 1000}, "Extent."),
           field<&Puddle::maximum_depth_mm>("maximum_depth_mm", "mm", {0, 1000}, "Depth at which it overflows."),
           field<&Puddle::area_share>("area_share", "", {0.01, 1}, "Wet area when full, of the rectangle."),
           field<&Puddle::catchment_ratio>("catchment_ratio", "", {0, 1000}, "Catchment area over puddle area."),
           field<&Puddle::shape>("shape", "", any, "How its wet area grows with the depth.", puddle_shapes),
           field<&Puddle::by_height>("by_height", "", any, "Depth by the ground's height, not by a material's mask."),
           field<&Puddle::drain_mm_per_hour>("drain_mm_per_hour", "mm/h", {0, 100000}, "Lost through the bottom."),
           field<&Puddle::evaporation_mm_per_hour>("evaporation_mm_per_hour", "mm/h", {0, 1000},
                                                   "Lost to the air while no rain falls."),
           field<&Puddle::initial_fill>("initial_fill", "", {-1, 1},
                                        "Depth at the start, of the greatest; -1: after history_min of the first rain."),
           field<&Puddle::history_min>("history_min", "min", {0, 10000}, "How long it has rained before the start."),
           field<&Puddle::time_scale>("time_scale", "", {0, 10000}, "How fast it fills and dries; 1 is true."),
           field<&Puddle::ripple_influence>("ripple_influence", "", {0, 1}, "p_i: of ripples against the ground."),
           field<&Puddle::ripple_scale>("ripple_scale", "", {0.01, 100}, "s_o: size of its ripples; 1 is true."),
           field<&Puddle::ripple_turn_deg>("ripple_turn_deg", "deg", {-36000, 36000},
                                           "theta_o: turns the look-up of its ripples.")}),
      schema<WetGround>(
          "wet_ground", "How surfaces take up water and dry; every emitter has it.",
          {field<&WetGround::initial_wetness>("initial_wetness", "", {-1, 1},
                                              "0 dry, 1 as after long rain; -1: wet where it rains at the start."),
           field<&WetGround::drying_speed>("drying_speed", "", {0.01, 10000},
                                           "Without rain, water runs off and dries so many times faster; 1 is true."),
           field<&WetGround::humidity>("humidity", "", {0, 1}, "Relative, once the rain has stopped."),
           field<&WetGround::temperature_c>("temperature_c", "C", {0.1, 50}, "Of air and ground."),
           field<&WetGround::published>("published", "", any, "Of wetness=everywhere: Lagarde's factors as printed.")}),
      schema<Ripples>(
          "ripples", "Rings on the water that stands; every emitter has them.",
          {field<&Ripples::published>("published", "", any, "As printed, with what is known to break."),
           field<&Ripples::strength>("strength", "", {0, 10}, "Multiplies all slopes; 1 is true."),
           field<&Ripples::wave_speed_mps>("wave_speed_mps", "m/s", {0.05, 2}, "Of all waves on the lattice."),
           field<&Ripples::decay_per_s>("decay_per_s", "1/s", {0.8, 20}, "Of the waves' heights."),
           field<&Ripples::tile_m>("tile_m", "m", {0.25, 8}, "Edge of the tile that all puddles share."),
           field<&Ripples::seed_cells>("seed_cells", "", {0.5, 8}, "Least deviation of a ring's seed, in cells.")}),
      schema<Wader>("wader", "Moves through standing water and leaves a wake.",
                    {field<&Wader::radius_m>("radius_m", "m", {0.02, 2}, "Of the disc that moves."),
                     field<&Wader::draft_mm>("draft_mm", "mm", {0, 100}, "Of the water that it pushes before it."),
                     field<&Wader::height_m>("height_m", "m", {0, 10},
                                             "Its place may be so far above or below the water.")}),
      schema<Splashes>(
          "splashes", "Settings of the splashes of the rain; every emitter has them.",
          {field<&Splashes::reach_m>("reach_m", "m", {0, 100}, "Single splashes are drawn out to here."),
           field<&Splashes::secondary_reach_m>("secondary_reach_m", "m", {0, 20}, "With their droplets out to here."),
           field<&Splashes::most_splashes>("most_splashes", "", {0, 1000000},
                                           "Alive at once, on average; the less important are thinned out."),
           field<&Splashes::size>("size", "", {0, 10}, "Multiplies the crowns; 1 is true."),
           field<&Splashes::size_variation>("size_variation", "", {0, 0.9}, "Of the size, either way, at random."),
           field<&Splashes::opacity>("opacity", "", {0, 1}, "Of the crowns."),
           field<&Splashes::opacity_variation>("opacity_variation", "", {0, 0.9}, "Either way, at random."),
           field<&Splashes::edge_strength>("edge_strength", "", {0, 10}, "e_s of section 3.2."),
           field<&Splashes::edge_bias>("edge_bias", "", {0, 10}, "e_b of section 3.2."),
           field<&Splashes::backlight>("backlight", "", {0, 100}, "Multiplies the light of lamps; 1 is true."),
           field<&Splashes::published>("published", "", any, "Of splashes=random: as printed.")}),
      schema<GlassPane>(
          "glass_pane", "Glass that droplets sit on: a rectangle in x and y.",
          {field<&GlassPane::size_m>("size_m", "m", {0.01, 1000}, "Extent."),
           field<&GlassPane::advancing_angle_deg>("advancing_angle_deg", "deg", {1, 179}, "Advancing contact angle."),
           field<&GlassPane::receding_angle_deg>("receding_angle_deg", "deg", {1, 179}, "Receding contact angle.")}),
      schema<RainCatcher>(
          "rain_catcher", "Rain splatters and mists on this and on what is below it.",
          {field<&RainCatcher::splatter>("splatter", "", {0, 100}, "Multiplies the rings' opacity; 1 is true."),
           field<&RainCatcher::shells>("shells", "", {1, 16}, "Layers that a splash is cut into."),
           field<&RainCatcher::shell_height_mm>("shell_height_mm", "mm", {0.5, 100}, "Height of the highest layer."),
           field<&RainCatcher::halo>("halo", "", {0, 1000}, "Multiplies the density of the mist; 1 is true."),
           field<&RainCatcher::halo_height>("halo_height", "", {0.1, 20}, "Multiplies its height; 1 is true."),
           field<&RainCatcher::published>("published", "", any, "As printed, with what is known to break.")}),
      schema<ReflectionProbe>(
          "reflection_probe", "A moving object that shines: it mirrors its own surroundings (probes=moving).",
          {field<&ReflectionProbe::centre_m>("centre_m", "m", {-100, 100}, "Of the object, along the entity's axes."),
           field<&ReflectionProbe::radius_m>("radius_m", "m", {0.05, 100},
                                             "Surfaces within it mirror what is round the centre.")}),
      schema<LightningDirector>(
          "lightning_director", "Directs strokes of lightning.",
          {field<&LightningDirector::flashes_per_minute>("flashes_per_minute", "1/min", {0, 60}, "Mean rate."),
           field<&LightningDirector::distance_m>("distance_m", "m", {0, 50000}, "Mean distance."),
           field<&LightningDirector::seed>("seed", "", {0, 4294967295.0}, "Which storm.")}),
      schema<MeshInstance>(
          "mesh_instance", "One mesh of a loaded model.",
          {field<&MeshInstance::model>("model", "", {0, 1e6}, "Index of the model."),
           field<&MeshInstance::mesh>("mesh", "", {0, 1e6}, "Index of the mesh in the model."),
           field<&MeshInstance::casts_shadow>("casts_shadow", "", any, "Whether it shades other things.")}),
      schema<Walker>("walker", "The person in the sandbox.",
                     {field<&Walker::eye_height_m>("eye_height_m", "m", {0.2, 10}, "Eyes above the ground."),
                      field<&Walker::radius_m>("radius_m", "m", {0.05, 5}, "Half the person's width."),
                      field<&Walker::walk_mps>("walk_mps", "m/s", {0, 100}, "Walking speed."),
                      field<&Walker::run_mps>("run_mps", "m/s", {0, 100}, "Running speed."),
                      field<&Walker::fly_mps>("fly_mps", "m/s", {0, 1000}, "Flying speed."),
                      field<&Walker::flying>("flying", "", any, "Fly instead of walking."),
                      field<&Walker::yaw_deg>("yaw_deg", "deg", any, "Heading."),
                      field<&Walker::pitch_deg>("pitch_deg", "deg", {-89, 89}, "Tilt of the head.")}),
  };
}

}  // namespace

std::span<const Schema> component_schemas() {
  static const std::vector<Schema> schemas = make_schemas();
  return schemas;
}

}  // namespace petrichor
