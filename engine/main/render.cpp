#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "engine/app/interrupt.hpp"
#include "engine/app/progress.hpp"
#include "engine/app/recorder.hpp"
#include "engine/core/log.hpp"
#include "engine/core/paths.hpp"
#include "engine/main/commands.hpp"
#include "engine/main/direction.hpp"
#include "engine/main/renderer.hpp"
#include "engine/main/stats.hpp"
#include "engine/main/world.hpp"
#include "systems/rainfall/passes.hpp"

namespace petrichor {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
const Clock::time_point program_start = Clock::now();
constexpr double warm_up_ms = 400.0;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Job {
  int width, height;
  double fps;
  FrameRange frames;
  RecordTarget target;
};

// What the call leaves open the script decides, and what it leaves open has a default.
Result<Job> plan(const RenderOptions& options, const World& world) {
  const Cinematic& said = world.cinematic();
  Job job;
  job.width = options.width ? options.width : said.size_px ? said.size_px->x : 1280;
  job.height = options.height ? options.height : said.size_px ? said.size_px->y : 720;
  job.fps = options.fps > 0.0 ? options.fps : said.fps.value_or(24.0);
  if (options.frames)
    job.frames = *options.frames;
  else if (said.duration_s)
    job.frames = {0, std::max<std::int64_t>(1, std::llround(*said.duration_s * job.fps))};
  else
    job.frames = {0, 1};
  fs::path out = options.out;
  if (out.empty()) {
    const bool film = job.frames.end - job.frames.begin > 1;
    out = fs::path("out") / (options.subject.subject.stem().string() + (film ? ".mp4" : ".png"));
  }
  auto target = record_target(out, job.frames.end - job.frames.begin);
  if (!target) return tl::unexpected(target.error());
  job.target = *target;
  return job;
}

}  // namespace

Result<void> render(const RenderOptions& options) {
  ContextOptions context;
  auto opened = open_renderer(false, context);
  if (!opened) return tl::unexpected(opened.error());
  Renderer& renderer = **opened;
  auto world_opened = World::open(options.subject, renderer.scene.get());
  if (!world_opened) return tl::unexpected(world_opened.error());
  World& world = **world_opened;
  world.set_affordable_drops(affordable_drops(renderer.device));
  const auto job = plan(options, world);
  if (!job) return tl::unexpected(job.error());
  if (auto loaded = load_render_script(renderer, world.render_script()); !loaded) return loaded;
  auto recorder = make_recorder(job->target, job->width, job->height, job->fps);
  if (!recorder) return tl::unexpected(recorder.error());

  auto direction = Direction::open(world.techniques());
  if (!direction) return tl::unexpected(direction.error());
  direction->budget_ms = options.budget_ms;
  const bool directed = options.budget_ms > 0.0;

  const bool want_stats = !options.stats.empty();
  const bool linear = job->target.kind == RecordKind::exr;
  RunStats stats;
  std::uint64_t drops_drawn = 0;
  std::vector<std::uint8_t> bytes;
  std::vector<float> floats;
  Frame frame;
  catch_interrupts();
  Progress progress("rendering", job->frames.end - job->frames.begin);
  for (std::int64_t number = job->frames.begin; number < job->frames.end; ++number) {
    if (interrupted())
      return failure(fmt::format("interrupted before frame {}{}", number,
                                 job->target.kind == RecordKind::film ? "; the unfinished film is removed" : ""));
    const double time_s = static_cast<double>(number) / job->fps;
    const bool first = number == job->frames.begin;
    if (directed && first) {
      if (auto advanced = world.advance_to(time_s); !advanced) return advanced;
      if (auto warm = direction->warm_up(renderer, world, time_s, job->width, job->height); !warm) return warm;
    }
    if (directed) glFinish();  // the picture before is read
    const auto work_start = Clock::now();
    if (auto advanced = world.advance_to(time_s); !advanced) return advanced;
    if (directed) {
      direction->extract(world, frame, static_cast<std::uint64_t>(number), time_s, first ? 0.0 : 1.0 / job->fps,
                         job->width, job->height);
    } else {
      const Size size = drawn_size(world.techniques(), job->width, job->height);
      world.extract(frame, static_cast<std::uint64_t>(number), time_s, size.width, size.height);
    }

    // Writing pictures takes longer than drawing them, and a GPU that waits lowers its clock: before a frame is timed
    // it is drawn again and again for a while.
    if (want_stats && !directed && !renderer.device.software)
      for (const auto begun = Clock::now(); milliseconds_since(begun) < warm_up_ms; glFinish())
        if (auto drawn = draw(renderer, frame, false); !drawn) return tl::unexpected(drawn.error());
    if (want_stats && !directed) glFinish();
    // With a budget the whole work of a frame counts, simulation too.
    const auto start = directed ? work_start : Clock::now();
    const auto drawn = draw(renderer, frame, directed && direction->profile());
    if (!drawn) return tl::unexpected(drawn.error());
    const Texture* picture = &enlarged(renderer, **drawn, job->width, job->height);
    if (want_stats || directed) {
      glFinish();
      const double frame_ms = milliseconds_since(start);
      const std::int64_t done = number - job->frames.begin;
      if (done == 0) stats.start_to_first_frame_s = milliseconds_since(program_start) / 1000.0;
      // The first frame compiles shaders and fills caches: it counts only where it is the only one.
      const bool counts = done > 0 || job->frames.end - job->frames.begin == 1;
      if (counts) stats.frame_ms.push_back(frame_ms);
      // On software OpenGL passes are timed on a second drawing of the same frame, so that the glFinishes between
      // them do not cost the first; every eighth frame will do.
      if (!directed && renderer.device.software && counts && done % 8 <= 1)
        if (auto again = draw(renderer, frame, true); !again) return tl::unexpected(again.error());
      const std::vector<Timing> timings = renderer.timer->collect();
      if (counts) stats.add(timings);
      if (directed) direction->measured(frame_ms, timings, renderer.timer->gpu_times_are_real());
      drops_drawn = rain_stats(frame).drops_drawn;
    }
    Picture recorded{job->width, job->height, {}, {}};
    if (linear) {
      const Texture* light = renderer.graph->linear_output();
      if (!light)
        return failure(fmt::format("{}: has no linear_output, which .exr needs", world.render_script().string()));
      read_picture(enlarged(renderer, *light, job->width, job->height), floats);
      for (float& value : floats) value *= frame.uniforms.lens.w;  // exposed: 1 is the picture's white
      recorded.rgba32f = floats;
    } else {
      read_picture(*picture, bytes);
      recorded.rgba8 = bytes;
    }
    if (auto added = (*recorder)->add(number, recorded); !added) return added;
    progress.advance_to(number - job->frames.begin + 1);
  }
  if (auto finished = (*recorder)->finish(); !finished) return finished;
  if (want_stats) {
    auto json = to_json(stats, renderer.device, job->width, job->height, job->frames.end - job->frames.begin,
                        drops_drawn, renderer.timer->gpu_times_are_real());
    // What the last frame was drawn by; nothing for what was not there.
    for (const Ladder& ladder : all_ladders())
      if (ladder.coverage(frame) > 0.0)
        json["techniques"][ladder.name] = ladder.rungs[frame.techniques[ladder.effect].rung].name;
    if (directed) {
      json["budget_ms"] = options.budget_ms;
      json["director"] = direction->report();
      json["director_changes"] = direction->changes();
      json["frames_ms"] = stats.frame_ms;  // each of them, to see what a change cost
    }
    if (auto written = write_whole_file(options.stats, json.dump(2) + "\n"); !written) return written;
  }
  log_info("{} ({}x{}, {} frames)", job->target.file.string(), job->width, job->height,
           job->frames.end - job->frames.begin);
  return {};
}

}  // namespace petrichor
