#include "systems/rainfall/sprites/bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "engine/core/log.hpp"
#include "engine/core/random.hpp"
#include "engine/gpu/shader.hpp"
#include "engine/gpu/timer.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/drops/layers.hpp"
#include "systems/drops/optics.hpp"
#include "systems/rainfall/passes.hpp"
#include "systems/rainfall/sprites/sprites.hpp"
#include "systems/rainfall/stage.hpp"

namespace petrichor {
namespace {

constexpr float nearest_m = 0.3f;  // as the field's and the sprites' passes have it
constexpr int warm_up = 4;

struct Particle {
  glm::vec4 place_diameter, velocity_random;
};

struct Weather {
  Emitter emitter;
  WindMotion motion;
  int width, height;

  Frame frame(double time_s, RainRung rung) const {
    Frame f = stage_frame(width, height, glm::dvec3(0.0, 1.7, 0.0));
    f.camera.vertical_fov_rad = glm::radians(45.0f);
    f.sky.zenith_cd_m2 = f.sky.horizon_cd_m2 = glm::vec3(0.0f);
    for (const glm::vec3 at :
         {glm::vec3(-4.0f, 4.0f, -10.0f), glm::vec3(-1.0f, 2.5f, -16.0f), glm::vec3(3.5f, 4.0f, -14.0f)}) {
      FrameLight light{};
      light.position_m = at;
      light.direction = {0.0f, -1.0f, 0.0f};
      light.intensity = glm::vec3(1.0f, 0.75f, 0.45f) * 800.0f;
      light.source_radius_m = 0.08f;
      light.kind = LIGHT_POINT;
      light.lights_rain = true;
      f.lights.push_back(light);
    }
    f.time_s = time_s;
    f.number = static_cast<std::uint64_t>(time_s * 60.0 + 0.5);
    f.rain = make_frame_rain(emitter, motion, f.camera, width, height, time_s);
    f.rain->techniques.set(Effect::rainfall, rung);
    f.rain->techniques.set(Effect::streaks, StreakRung::even);
    return f;
  }
};

// Rain to the distance that holds that many drops in view; where that is farther than 30 m, heavier rain, to 50 mm/h.
Weather weather_of(int drops, int width, int height) {
  Weather weather{{}, {}, width, height};
  Emitter& emitter = weather.emitter;
  emitter.maximum_drops = 400'000'000;
  emitter.rain_mm_per_hour = 10.0f;
  Wind wind;
  wind.velocity_mps = {1.0f, 0.0f, 0.0f};
  weather.motion = start_rain_motion(emitter, wind);
  const auto distance_of_drops = [&] {
    emitter.drawn_distance_m = 5.0f;
    const Frame near = weather.frame(0.0, RainRung::drop_field);
    return 5.0f * std::cbrt(static_cast<float>(drops) / near.rain->expected_drops);
  };
  float distance_m = distance_of_drops();
  while (emitter.rain_mm_per_hour < 50.0f && distance_m > 30.0f) {
    emitter.rain_mm_per_hour += 1.0f;
    distance_m = distance_of_drops();
  }
  emitter.drawn_distance_m = distance_m;
  return weather;
}

// The drops of the field that the view holds, as field.glsl makes them.
std::vector<Particle> field_particles(const Frame& frame) {
  const FrameRain& rain = *frame.rain;
  const RainLayers layers = view_layers(rain, frame.camera, frame.width, frame.height);
  const float tall = frame.uniforms.lens.x, wide = tall * frame.uniforms.lens.y;
  std::vector<Particle> particles;
  for (const RainLayerGpu& layer : layers.layers) {
    for (std::uint32_t i = 0; i < layer.box.x * layer.box.y * layer.box.z; ++i) {
      const glm::uvec3 cell(i % layer.box.x, i / layer.box.x % layer.box.y, i / (layer.box.x * layer.box.y));
      const glm::ivec3 place = glm::ivec3(layer.first_cell) + glm::ivec3(cell);
      const glm::uvec4 key = random_bits4(glm::uvec4(key_of(place.x), key_of(place.y), key_of(place.z),
                                                     std::uint32_t(layer.first_cell.w) ^ (rain.seed * 0x9e3779b9u)));
      const std::uint32_t count = poisson_count(unit_float(key.x), layer.expected.x, layer.expected.y, 255u);
      for (std::uint32_t m = 0; m < count; ++m) {
        const glm::uvec4 b = random_bits4(glm::uvec4(key.y, key.z, m, key.w));
        const glm::vec3 at =
            glm::vec3(layer.corner_edge) +
            layer.corner_edge.w * (glm::vec3(cell) + glm::vec3(unit_float(b.x), unit_float(b.y), unit_float(b.z)));
        const float mark = static_cast<float>(((b.x & 255u) << 8u) | (b.y & 255u)) / 65536.0f;
        const float fade_m = layer.expected.z * glm::mix(rain.fade_start_m, rain.drawn_distance_m, mark);
        // The camera looks along -z.
        if (-at.z < nearest_m || std::abs(at.x) > wide * -at.z || std::abs(at.y) > tall * -at.z ||
            glm::length(at) > fade_m)
          continue;
        particles.push_back(
            {glm::vec4(at, layer.velocity_diameter.w), glm::vec4(glm::vec3(layer.velocity_diameter), unit_float(b.w))});
      }
    }
  }
  return particles;
}

// As many in a box about the camera, of the sizes in the air.
std::vector<Particle> box_particles(const FrameRain& rain, int count, float box_m) {
  std::vector<double> below;
  double density = 0.0;
  for (const RainClass& c : rain.classes) below.push_back(density += c.drawn ? c.drops_per_m3 : 0.0);
  RandomStream random(rain.seed);
  std::vector<Particle> particles;
  particles.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double share = random.uniform() * density;
    const auto k = std::min<std::size_t>(
        std::size_t(std::upper_bound(below.begin(), below.end(), share) - below.begin()), rain.classes.size() - 1);
    const glm::vec3 at(random.uniform(-0.5f, 0.5f), random.uniform(-0.5f, 0.5f), random.uniform(-0.5f, 0.5f));
    particles.push_back({glm::vec4(at * box_m, rain.classes[k].diameter_mm * 1e-3f),
                         glm::vec4(rain.classes[k].velocity_mps, random.uniform())});
  }
  return particles;
}

// His library has over 300 textures of streaks; the database they come from may not be shipped, and what they show does
// not matter to the time: here, bands in different places.
Texture make_streak_textures(int layers) {
  constexpr int across = 16, along = 512;
  Texture array = make_texture_2d_array(across, along, layers, GL_R8, full_mip_levels(across, along));
  std::vector<unsigned char> texels(std::size_t(across) * along);
  for (int layer = 0; layer < layers; ++layer) {
    for (int y = 0; y < along; ++y)
      for (int x = 0; x < across; ++x) {
        const double band =
            std::cos(6.2832 * (3.0 * y / along + double(layer) / layers)) * std::sin(3.1416 * (x + 0.5) / across);
        texels[std::size_t(y) * across + x] = static_cast<unsigned char>(std::lround(127.5 + 90.0 * band));
      }
    glTextureSubImage3D(array.id, 0, 0, 0, layer, across, along, 1, GL_RED, GL_UNSIGNED_BYTE, texels.data());
  }
  glGenerateTextureMipmap(array.id);
  glTextureParameteri(array.id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  return array;
}

// Of each timed frame the sum of the named spans.
class Spans {
 public:
  void add(const std::vector<Timing>& timings) {
    if (timings.empty()) return;
    std::map<std::string, double> frame;
    for (const Timing& t : timings) frame[t.name] += t.milliseconds;
    frames_.push_back(std::move(frame));
  }
  BenchRow row(const std::string& name, std::initializer_list<const char*> spans, const std::string& n,
               const std::string& size, bool gpu) const {
    std::vector<double> sums;
    for (const auto& frame : frames_) {
      double sum = 0.0;
      for (const char* span : spans)
        if (const auto found = frame.find(span); found != frame.end()) sum += found->second;
      sums.push_back(sum);
    }
    const double median = quantile(sums, 0.5);
    return {name, n, size, median, quantile(sums, 0.95), gpu ? std::optional<double>(median) : std::nullopt};
  }

 private:
  std::vector<std::map<std::string, double>> frames_;
};

// His path, a frame at a time.
class TariqPath {
 public:
  static Result<std::unique_ptr<TariqPath>> make(const Weather& weather, bool software) {
    std::unique_ptr<TariqPath> path(new TariqPath(weather, software));
    const std::string folder = "systems/rainfall/sprites/tariq_";
    const auto animate = path->library_.load({{folder + "animate.vert.glsl"}, {}});
    if (!animate) return tl::unexpected(animate.error());
    for (const bool simple : {false, true}) {
      std::vector<std::string> defines;
      if (simple) defines.push_back("SIMPLE");
      const auto draw = path->library_.load(
          {{folder + "draw.vert.glsl", folder + "draw.geom.glsl", folder + "draw.frag.glsl"}, defines});
      if (!draw) return tl::unexpected(draw.error());
      (simple ? path->draw_simple_ : path->draw_) = *draw;
    }
    path->animate_ = *animate;
    path->textures_ = make_streak_textures(370);
    path->colour_ = make_texture_2d(weather.width, weather.height, GL_RGBA16F);
    const std::array<GLuint, 1> colours{path->colour_.id};
    path->framebuffer_ = make_framebuffer(colours, 0);
    GLuint vertices = 0;
    glCreateVertexArrays(1, &vertices);
    path->vertices_ = VertexArray(vertices);
    for (GLuint attribute = 0; attribute < 3; ++attribute) {
      glEnableVertexArrayAttrib(vertices, attribute);
      glVertexArrayAttribFormat(vertices, attribute, attribute < 2 ? 4 : 3, GL_FLOAT, GL_FALSE,
                                attribute == 1 ? 16 : 0);
      glVertexArrayAttribBinding(vertices, attribute, attribute < 2 ? 0 : 1);
    }
    return path;
  }

  void spawn(const std::vector<Particle>& particles) {
    count_ = static_cast<GLsizei>(particles.size());
    for (Buffer& buffer : buffers_) buffer = make_buffer(particles.size() * sizeof(Particle), particles.data());
    std::vector<glm::vec4> seeds;
    for (const Particle& p : particles) seeds.push_back(p.place_diameter);
    seeds_ = make_buffer(seeds.size() * sizeof(glm::vec4), seeds.data());
    current_ = 0;
  }

  void step(int i) {
    Frame frame = weather_.frame(10.0 + i / 60.0, RainRung::drop_field);
    finish_frame(frame);
    frame_gpu_.upload(frame);
    bind_rain_optics(optics_, frame);
    clear_texture(colour_, {0.0f, 0.0f, 0.0f, 1.0f});
    timer_.begin_frame(true);
    timer_.begin("animate");
    animate();
    timer_.end();
    timer_.begin("draw_simple");
    draw(frame, *draw_simple_);
    timer_.end();
    clear_texture(colour_, {0.0f, 0.0f, 0.0f, 1.0f});
    timer_.begin("draw");
    draw(frame, *draw_);
    timer_.end();
    timer_.end_frame();
    glFinish();
    const std::vector<Timing> timings = timer_.collect();
    if (i >= warm_up) spans.add(timings);
  }

  // Whether particles have fallen since they were spawned: the feedback works.
  bool moved() const {
    std::vector<Particle> now(static_cast<std::size_t>(std::min(count_, 256)));
    std::vector<glm::vec4> seeds(now.size());
    read_buffer(buffers_[current_], now.data(), now.size() * sizeof now[0]);
    read_buffer(seeds_, seeds.data(), seeds.size() * sizeof seeds[0]);
    std::size_t fallen = 0;
    for (std::size_t i = 0; i < now.size(); ++i)
      if (now[i].place_diameter.y < seeds[i].y - 0.01f) ++fallen;
    return fallen > 0;
  }

  std::vector<float> read_light() const {
    std::vector<float> pixels(std::size_t(colour_.width) * colour_.height * 4);
    glGetTextureImage(colour_.id, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(pixels.size() * sizeof(float)),
                      pixels.data());
    return pixels;
  }
  bool gpu_times() const { return timer_.gpu_times_are_real(); }

  Spans spans;

 private:
  TariqPath(const Weather& weather, bool software) : weather_(weather), software_(software), timer_(software) {}

  void animate() {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);  // without a window, even what draws nothing wants one
    glBindVertexArray(vertices_);
    glVertexArrayVertexBuffer(vertices_, 0, buffers_[current_].id, 0, sizeof(Particle));
    glVertexArrayVertexBuffer(vertices_, 1, seeds_.id, 0, sizeof(glm::vec4));
    animate_->use();
    animate_->set("step_s", 1.0f / 60.0f);
    animate_->set("fall_m", 0.2f);  // so that they stay in view
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffers_[1 - current_].id);
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, count_);
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    glBindVertexArray(0);
    current_ = 1 - current_;
  }

  void draw(const Frame& frame, const Program& program) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glViewport(0, 0, frame.width, frame.height);
    glBindVertexArray(vertices_);
    glVertexArrayVertexBuffer(vertices_, 0, buffers_[current_].id, 0, sizeof(Particle));
    program.use();
    program.set("distances", glm::vec3(nearest_m, 1e6f, 1e6f));
    glBindTextureUnit(0, textures_.id);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    glDrawArrays(GL_POINTS, 0, count_);
    glDisable(GL_BLEND);
    glBindVertexArray(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
  }

  Weather weather_;
  bool software_;
  ShaderLibrary library_;
  FrameTimer timer_;
  FrameGpu frame_gpu_;
  RainOptics optics_;
  const Program* animate_ = nullptr;
  const Program* draw_ = nullptr;
  const Program* draw_simple_ = nullptr;
  Texture textures_, colour_;
  Framebuffer framebuffer_;
  VertexArray vertices_;
  std::array<Buffer, 2> buffers_;
  Buffer seeds_;
  int current_ = 0;
  GLsizei count_ = 0;
};

double mean_light(const std::vector<float>& light) {
  double sum = 0.0;
  for (std::size_t p = 0; p < light.size(); p += 4) sum += light[p] + light[p + 1] + light[p + 2];
  return sum / 3.0 / (static_cast<double>(light.size()) / 4.0);
}

// The engine's own, a frame at a time.
class StageRun {
 public:
  static Result<StageRun> make(const Weather& weather, RainRung rung, bool software, float box_m) {
    StageSet set;
    set.present = false;
    auto stage = RainStage::make(software, set);
    if (!stage) return tl::unexpected(stage.error());
    return StageRun(weather, rung, box_m, std::move(*stage));
  }

  Result<void> step(int i) {
    FrameTimer& timer = stage_->timer();
    Frame frame = weather_.frame(10.0 + i / 60.0, rung_);
    if (rung_ == RainRung::sprites) {
      frame.rain->sprites = make_frame_sprites({}, *frame.rain);
      frame.rain->sprites.box_m = box_m_;
    }
    timer.begin_frame(true);
    if (auto drawn = stage_->draw(frame); !drawn) return drawn;
    timer.end_frame();
    glFinish();
    const std::vector<Timing> timings = timer.collect();
    if (i >= warm_up) spans.add(timings);
    drops = rain_stats(frame).drops_drawn;
    return {};
  }
  double light() const { return mean_light(stage_->read_light()); }

  Spans spans;
  std::uint32_t drops = 0;

 private:
  StageRun(const Weather& weather, RainRung rung, float box_m, std::unique_ptr<RainStage> stage)
      : weather_(weather), rung_(rung), box_m_(box_m), stage_(std::move(stage)) {}
  Weather weather_;
  RainRung rung_;
  float box_m_;
  std::unique_ptr<RainStage> stage_;
};

// By turns, so that a machine that others use is as slow to both.
Result<void> run_by_turns(TariqPath& his, StageRun& ours, int frames, bool software) {
  his.spans = {};
  const int total = warm_up + frames + (software ? 0 : 8);  // GPU times come some frames late
  for (int i = 0; i < total; ++i) {
    his.step(i);
    if (auto drawn = ours.step(i); !drawn) return drawn;
  }
  if (!his.moved()) return failure("the particles of the benchmark do not move: no transform feedback");
  return {};
}

}  // namespace

Result<std::vector<BenchRow>> bench_tariq(int drops, int width, int height, int frames, bool software_gl) {
  const Weather weather = weather_of(drops, width, height);
  const std::string n = std::to_string(drops), size = std::to_string(width) + "x" + std::to_string(height);
  Frame first = weather.frame(10.0, RainRung::drop_field);
  finish_frame(first);
  auto tariq = TariqPath::make(weather, software_gl);
  if (!tariq) return tl::unexpected(tariq.error());
  const bool gpu = (*tariq)->gpu_times();

  const std::vector<Particle> in_view = field_particles(first);
  (*tariq)->spawn(in_view);
  auto field = StageRun::make(weather, RainRung::drop_field, software_gl, 0.0f);
  if (!field) return tl::unexpected(field.error());
  if (auto ran = run_by_turns(**tariq, *field, frames, software_gl); !ran) return tl::unexpected(ran.error());
  const Spans his = (*tariq)->spans;
  log_info("{:.0f} mm/h to {:.1f} m: {} of his particles in view, {} drops of the field; mean light {:.4g} and {:.4g}",
           weather.emitter.rain_mm_per_hour, weather.emitter.drawn_distance_m, in_view.size(), field->drops,
           mean_light((*tariq)->read_light()), field->light());

  double density = 0.0;
  for (const RainClass& c : first.rain->classes) density += c.drawn ? c.drops_per_m3 : 0.0;
  const auto box_m = static_cast<float>(std::cbrt(drops / density));
  (*tariq)->spawn(box_particles(*first.rain, drops, box_m));
  auto sprites = StageRun::make(weather, RainRung::sprites, software_gl, box_m);
  if (!sprites) return tl::unexpected(sprites.error());
  if (auto ran = run_by_turns(**tariq, *sprites, frames, software_gl); !ran) return tl::unexpected(ran.error());
  log_info("a box of {:.1f} m about the camera: {} of {} particles in view", box_m, sprites->drops, drops);

  const auto row = [&](const Spans& spans, const char* name, std::initializer_list<const char*> passes) {
    return spans.row(std::string("tariq/") + name, passes, n, size, gpu);
  };
  return std::vector<BenchRow>{
      row(his, "animate_transform_feedback", {"animate"}),
      row(his, "draw_geometry_shader", {"draw"}),
      row(his, "draw_simple_shader", {"draw_simple"}),
      row(his, "total", {"animate", "draw"}),
      row(field->spans, "drop_field", {"rain_cells", "rain_splat"}),
      row(field->spans, "drop_field_composite", {"rain_cells", "rain_splat", "rain_composite"}),
      row((*tariq)->spans, "box_total", {"animate", "draw"}),
      row(sprites->spans, "sprites", {"rain_sprites"}),
      row(sprites->spans, "sprites_composite", {"rain_sprites", "rain_composite"})};
}

}  // namespace petrichor
