#include "systems/rainfall/sprites/passes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "systems/drops/lists.hpp"
#include "systems/rainfall/sprites/sprites.hpp"
#include "systems/rainfall/streaks/gpu.hpp"

namespace petrichor {
namespace {

struct SpritesGpu {
  Buffer classes, sprites, lights, states, command, read_back;
  std::uint32_t class_count = 0, particles = 0, known = 0, capacity = 0;
  int cells_across = 1;
  bool software_device = false, device_known = false;
  std::uint64_t frame_number = std::numeric_limits<std::uint64_t>::max();
  std::shared_ptr<RainOptics> optics;
  std::shared_ptr<RainSums> sums;
};

std::weak_ptr<SpritesGpu> newest;

bool draws_sprites(const Frame& frame) {
  return frame.rain && frame.rain->rain_mm_per_hour > 0.0f && frame.rain->share(RainRung::sprites) > 0.0f;
}

void bind(GLuint binding, const Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id);
}

glm::vec3 distances(const Frame& frame) {
  const FrameSprites& s = frame.rain->sprites;
  return {std::max(frame.camera.near_m, 0.3f), s.fade_start_m(), s.far_m()};  // nearest: as the field's
}

// Particles that a view sees of a box about it, on average, as a share: of the sphere in the box, the part in the
// pyramid, and as much again for what comes and goes while the shutter is open.
double seen_share(const Frame& frame) {
  const double a = frame.uniforms.lens.x, b = a * frame.uniforms.lens.y;
  return std::min(1.0, 2.0 * 0.5236 * std::asin(a * b / std::sqrt((1.0 + a * a) * (1.0 + b * b))) / 3.1416);
}

void dispatch_over(std::uint32_t invocations, std::uint32_t group) {
  const std::uint32_t groups = (invocations + group - 1) / group, wide = std::min(groups, 16384u);
  if (groups > 0) glDispatchCompute(wide, (groups + wide - 1) / wide, 1);
}

// Places of all particles, and the list of those in view.
void animate(SpritesGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  const FrameRain& rain = *frame.rain;
  const FrameSprites& sprites = rain.sprites;
  const RainCommand start;
  upload(gpu.command, &start, sizeof start);
  // What is not drawn need not be known, but for what integrates its state.
  const double fraction = sprites.published ? 1.0 : sprites.drawn_share();
  const SpriteClasses made = sprite_classes(rain, frame.camera.position_m, rain.share(RainRung::sprites) * fraction);
  // Particles of other classes than there are now begin anew.
  if (gpu.class_count != made.classes.size()) gpu.known = 0;
  gpu.class_count = static_cast<std::uint32_t>(made.classes.size());
  gpu.particles = made.particles;
  if (!sprites.published) gpu.known = 0;
  if (gpu.particles == 0) return;
  upload(gpu.classes, std::span<const SpriteClassGpu>(made.classes));
  gpu.capacity =
      static_cast<std::uint32_t>(std::min<double>(gpu.particles, 65536.0 + gpu.particles * 1.5 * seen_share(frame)));
  if (gpu.sprites.bytes < gpu.capacity * sizeof(SpriteGpu))
    gpu.sprites = make_buffer((std::size_t(gpu.capacity) + gpu.capacity / 4) * sizeof(SpriteGpu));
  bind(SPRITES_BINDING, gpu.sprites);
  bind(SPRITE_CLASSES_BINDING, gpu.classes);
  bind(RAIN_COMMAND_BINDING, gpu.command);
  const Program& program = context.program(sprites.published ? "animate_published" : "animate");
  program.use();
  program.set("class_count", unsigned(gpu.class_count));
  program.set("particles", unsigned(gpu.particles));
  program.set("capacity", unsigned(gpu.capacity));
  program.set("seed", unsigned(rain.seed));
  program.set("box_m", sprites.box_m);
  program.set("distances", distances(frame));
  if (sprites.published) {
    if (gpu.states.bytes < gpu.particles * sizeof(SpriteStateGpu)) {
      gpu.states = make_buffer(gpu.particles * sizeof(SpriteStateGpu));
      gpu.known = 0;
    }
    bind(SPRITE_STATES_BINDING, gpu.states);
    gpu.known = std::min(gpu.known, gpu.particles);
    program.set("known", unsigned(gpu.known));
    program.set("shown", static_cast<unsigned>(std::lround(gpu.particles * double(sprites.drawn_share()))));
    program.set("step_s", sprites.frozen ? 0.0f : frame.step_s);
    program.set("wind_mps", sprite_wind(rain, 0));  // of the smallest drops, which follow the air most closely
    gpu.known = gpu.particles;
  }
  dispatch_over(gpu.particles, SPRITE_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void light_cells(SpritesGpu& gpu, PassContext& context) {
  // Cells of about the size of the field's, which hold some 56 drops: a few lamps are nearest to all of one.
  const float box_m = context.frame.rain->sprites.box_m;
  gpu.cells_across = std::clamp(static_cast<int>(std::lround(box_m / 1.5f)), 4, 16);
  const auto cells = static_cast<std::size_t>(gpu.cells_across * gpu.cells_across * gpu.cells_across);
  if (gpu.lights.bytes < cells * sizeof(SpriteLightsGpu)) gpu.lights = make_buffer(cells * sizeof(SpriteLightsGpu));
  bind(SPRITE_LIGHTS_BINDING, gpu.lights);
  const Program& program = context.program(gpu.sums->software ? "lights_software" : "lights");
  program.use();
  program.set("box_m", box_m);
  program.set("cells_across", gpu.cells_across);
  program.set("least_radiance", context.parameter("least_radiance"));
  dispatch_over(static_cast<std::uint32_t>(cells), 64);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void prepare_drawing(const SpritesGpu& gpu, PassContext& context, const Program& program, std::uint32_t first,
                     std::uint32_t end) {
  const FrameSprites& sprites = context.frame.rain->sprites;
  program.use();
  program.set("distances", distances(context.frame));
  program.set("use_occlusion", int(context.has("occlusion_map")));
  program.set("box_m", sprites.box_m);
  program.set("cells_across", gpu.cells_across);
  program.set("responses", glm::vec2(sprites.directional_response, sprites.lamp_response));
  program.set("first_sprite", unsigned(first));
  program.set("end_sprite", unsigned(end));
}

// The streak table for those that find a drop's bands and for those that draw them.
void give_streak_table(SpritesGpu& gpu, PassContext& context, const Program& drawing, bool scene, bool lamps) {
  const bool software = gpu.sums->software;
  for (const std::string_view lines :
       {software ? std::string_view("lines") : "long_lines", software ? std::string_view("capsules") : "long_capsules"})
    bind_streak_table(*gpu.optics, context.frame, context.program(drop_shader(lines, scene, lamps)));
  bind_streak_table(*gpu.optics, context.frame, drawing);
  if (context.frame.rain->sprites.simple_shader) drawing.set("streak_strength", 0.0f);
}

void draw_listed(SpritesGpu& gpu, PassContext& context) {
  const bool scene = context.has("depth"), lamps = context.frame.uniforms.counts.x > 0, software = gpu.sums->software;
  if (scene) context.bind_texture(0, "depth");
  if (scene && context.has("occlusion_map")) context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
  if (lamps) light_cells(gpu, context);
  bind_streak_lists(*gpu.sums, software);
  const Program& drawing = context.program(drop_shader(software ? "draw_software" : "draw", scene, lamps));
  give_streak_table(gpu, context, drawing, scene, lamps);
  if (!software) {
    prepare_drawing(gpu, context, drawing, 0, gpu.capacity);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, gpu.command.id);
    glDispatchComputeIndirect(0);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
    draw_long_streaks(gpu.command, context, scene, lamps);
    return;
  }
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  RainCommand command;
  read_buffer(gpu.command, &command, sizeof command);
  const std::uint32_t listed = std::min(command.cell_count, gpu.capacity);
  constexpr std::uint32_t slice = RAIN_STREAK_CAPACITY;  // all of them may come into one list
  for (std::uint32_t first = 0; first < listed; first += slice) {
    const std::uint32_t end = std::min(listed, first + slice);
    prepare_drawing(gpu, context, drawing, first, end);
    drawing.dispatch(static_cast<int>(end - first));
    draw_sorted_streaks(gpu.command, context, scene, lamps);
  }
}

void draw(SpritesGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  if (!gpu.device_known) gpu.software_device = is_software_gl();
  gpu.device_known = true;
  const float path = context.parameter("path");
  gpu.sums->software = path == 0.0f ? gpu.software_device : path == 2.0f;
  gpu.frame_number = frame.number;
  bind_rain_optics(*gpu.optics, frame);
  bind_rain_sums(*gpu.sums, context.width, context.height);
  animate(gpu, context);
  if (gpu.particles > 0 && !frame.rain->sprites.hidden) draw_listed(gpu, context);
}

}  // namespace

std::vector<PassOffer> sprites_passes(std::shared_ptr<RainOptics> optics, std::shared_ptr<RainSums> sums) {
  auto gpu = std::make_shared<SpritesGpu>();
  gpu->optics = std::move(optics);
  gpu->sums = std::move(sums);
  newest = gpu;
  const std::string folder = "systems/rainfall/sprites/";
  std::vector<PassOffer> offers(1);
  PassOffer& offer = offers[0];
  offer.name = "rain_sprites";
  offer.meaning =
      "particles in a box about the camera as streaks, into the sums that rain_composite lays over the picture";
  offer.slots = {{"depth", SlotAccess::read, true}, {"occlusion_map", SlotAccess::read, true}};
  // path: as rain_cells'.
  offer.parameters = {{"least_radiance", 0.004}, {"path", 0.0}};
  offer.shaders = {{"animate", {{folder + "sprites_animate.comp.glsl"}, {}}},
                   {"animate_published", {{folder + "sprites_animate.comp.glsl"}, {"PUBLISHED"}}},
                   {"lights", {{folder + "sprites_lights.comp.glsl"}, {}}},
                   {"lights_software", {{folder + "sprites_lights.comp.glsl"}, {"SOFTWARE"}}}};
  add_drop_shaders(offer, "draw", folder + "sprites_draw.comp.glsl", "draw_software",
                   folder + "sprites_draw.comp.glsl");
  offer.wanted = draws_sprites;
  offer.execute = [gpu](PassContext& context) { draw(*gpu, context); };
  return offers;
}

std::uint32_t sprites_drawn(const Frame& frame) {
  const auto gpu = newest.lock();
  if (!gpu || gpu->frame_number != frame.number || gpu->particles == 0) return 0;
  // By way of a copy: a driver may move a buffer that is read into the computer's memory, where atomics are slow.
  RainCommand command;
  if (gpu->read_back.bytes == 0) gpu->read_back = make_buffer(sizeof command);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(gpu->command.id, gpu->read_back.id, 0, 0, sizeof command);
  read_buffer(gpu->read_back, &command, sizeof command);
  return command.drops_drawn;
}

std::vector<SpriteStateGpu> read_sprite_states() {
  const auto gpu = newest.lock();
  if (!gpu || gpu->known == 0) return {};
  std::vector<SpriteStateGpu> states(gpu->known);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  read_buffer(gpu->states, states.data(), states.size() * sizeof states[0]);
  return states;
}

}  // namespace petrichor
