#include "engine/app/options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <iostream>

namespace petrichor {
namespace {

constexpr int largest_side = 16384;

bool parse_int(std::string_view text, std::int64_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

// Splits "AxB" or "A:B" into two integers.
bool parse_pair(std::string_view text, char separator, std::int64_t& a, std::int64_t& b) {
  const auto at = text.find(separator);
  return at != std::string_view::npos && parse_int(text.substr(0, at), a) && parse_int(text.substr(at + 1), b);
}

// As CLI::Range, which lets NaN through.
CLI::Validator between(double low, double high) {
  const std::string range = fmt::format("{} to {}", low, high);
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return std::string();
        return fmt::format("expected a number from {}; got '{}'", range, text);
      },
      "FROM " + range);
}

void add_size(CLI::App& app, int& width, int& height) {
  app.add_option_function<std::string>(
         "--size",
         [&](const std::string& text) {
           std::int64_t w = 0, h = 0;
           if (!parse_pair(text, 'x', w, h) || w < 1 || h < 1 || w > largest_side || h > largest_side)
             throw CLI::ValidationError(
                 "--size", "expected WIDTHxHEIGHT of 1 to 16384 pixels, for example 640x360; got '" + text + "'");
           width = static_cast<int>(w);
           height = static_cast<int>(h);
         },
         "Pixels of the picture, WIDTHxHEIGHT")
      ->type_name("WxH");
}

void add_assignments(CLI::App& app, const std::string& name, std::vector<std::string>& values, const std::string& shape,
                     const std::string& help) {
  app.add_option_function<std::vector<std::string>>(
         name,
         [&values, name, shape](const std::vector<std::string>& given) {
           for (const std::string& text : given) {
             const auto equals = text.find('=');
             if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
               throw CLI::ValidationError(name, "expected " + shape + "; got '" + text + "'");
             values.push_back(text);
           }
         },
         help)
      ->type_name(shape)
      ->allow_extra_args(false);
}

void add_budget(CLI::App& app, double& budget_ms) {
  app.add_option("--budget", budget_ms,
                 "Milliseconds that a frame may take: the director chooses the techniques. The picture then depends on "
                 "the machine")
      ->type_name("MS")
      ->check(between(0.01, 100000.0));
}

void add_subject(CLI::App& app, SubjectOptions& subject, bool required) {
  auto* option =
      app.add_option("subject", subject.subject, "A Lua script, or any .gltf or .glb model to put in the rain")
          ->type_name("SCRIPT|MODEL");
  if (required) option->required();
  add_assignments(app, "--set", subject.sets, "component.field=value",
                  "Set a field of every entity that has the component, after the script's own set-up (repeatable)");
  add_assignments(app, "--technique", subject.techniques, "effect=rung",
                  "Draw an effect by this technique; `petrichor info` lists them (repeatable)");
  app.add_option("--seed", subject.seed, "Which of all possible rains")->capture_default_str();
}

}  // namespace

ParsedCommandLine parse_command_line(int argc, char** argv) {
  PlayOptions play;
  RenderOptions render;
  BenchOptions bench;
  ChartOptions chart;
  MeasureOptions measure;
  BakeOptions bake;
  InfoOptions info;
  ParsedCommandLine parsed;

  CLI::App app{"Petrichor: a city in the rain, in real time, physically true and measured.", "petrichor"};
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("petrichor ") + PETRICHOR_VERSION);
  app.add_flag("-v,--verbose", parsed.verbose, "Say more on standard error");
  app.footer(
      "Examples:\n"
      "  petrichor play                                        walk the city in the rain\n"
      "  petrichor render scripts/cinematics/first_rain.lua    film a script\n"
      "  petrichor render model.glb --set emitter.rain_mm_per_hour=50 --out still.png\n"
      "  petrichor measure rain --rate 25                      is it really 25 mm/h?\n"
      "Exit codes: 0 done, 1 the work failed, 2 the call was wrong.");

  auto* play_app = app.add_subcommand("play", "Walk about in a window (default: scripts/sandbox.lua)");
  add_subject(*play_app, play.subject, false);
  add_size(*play_app, play.width, play.height);
  play_app->add_option("--stop-after", play.stop_after_frames, "Leave after this many frames")
      ->check(CLI::NonNegativeNumber);
  add_budget(*play_app, play.budget_ms);
  play_app->add_option("--stats", play.stats, "Write times and counts as JSON on leaving")->type_name("FILE.json");
  play_app->footer(
      "Keys: WASD and mouse walk, Shift runs, Space jumps or rises, F flies, F1 times, F2 inspector,\n"
      "1 drizzle, 2 rain, 3 downpour, 4 dry, Tab frees the mouse, Esc leaves.");

  auto* render_app = app.add_subcommand("render", "Render frames to a film or to pictures, without a window");
  add_subject(*render_app, render.subject, true);
  add_size(*render_app, render.width, render.height);
  render_app->add_option("--fps", render.fps, "Frames per second")->check(between(0.01, 10000.0));
  render_app
      ->add_option_function<std::string>(
          "--frames",
          [&](const std::string& text) {
            FrameRange range;
            if (!parse_pair(text, ':', range.begin, range.end) || range.begin < 0 || range.end <= range.begin)
              throw CLI::ValidationError(
                  "--frames", "expected A:B, the frames from A up to but not including B; got '" + text + "'");
            render.frames = range;
          },
          "Frames from A up to, not including, B; the same bytes as in a whole run")
      ->type_name("A:B");
  render_app->add_option("--out", render.out,
                         "FILE.png or .exr (one frame; with %04d in the name, each frame), or .mp4, .mkv, .webm, .mov");
  render_app->add_option("--stats", render.stats, "Write times and counts as JSON")->type_name("FILE.json");
  add_budget(*render_app, render.budget_ms);

  auto* bench_app = app.add_subcommand("bench", "Measure speed; one JSON row a case");
  bench_app->add_option("names", bench.names, "Which benchmarks (default: all): ecs, rain, rungs, near_drops, tariq")
      ->type_name("NAME");
  bench_app->add_option("--drops", bench.drops, "Drops of the rain benchmark")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1000000000}))
      ->capture_default_str();
  add_size(*bench_app, bench.width, bench.height);
  bench_app->add_option("--frames", bench.frames, "Frames timed")->check(CLI::Range(1, 1000000))->capture_default_str();
  bench_app->add_option("--json", bench.json, "Write there instead of standard output")->type_name("FILE");

  auto* chart_app = app.add_subcommand("chart", "Chart speed against accuracy");
  chart_app
      ->add_option("effects", chart.effects,
                   "Which (default: all): rainfall, streaks, near_drops, occlusion, classes, snow")
      ->type_name("EFFECT");
  chart_app->add_option("--out", chart.out, "Folder for the tables and pictures")->capture_default_str();
  chart_app->add_option("--redraw", chart.redraw, "Measure nothing: draw the tables of this folder again")
      ->type_name("FOLDER");

  auto* measure_app = app.add_subcommand("measure", "Read physical quantities from the running system, as JSON");
  measure_app->require_subcommand(1);
  auto* measure_rain = measure_app->add_subcommand("rain", "Count the water that crosses a plane in the drop field");
  measure_rain->add_option("--rate", measure.rate_mm_per_hour, "Asked rain rate, mm/h")
      ->check(between(0.0, 300.0))
      ->capture_default_str();
  measure_rain->add_option("--wind", measure.wind_mps, "Wind speed, m/s")
      ->check(between(-80.0, 80.0))
      ->capture_default_str();
  measure_rain->add_option("--seconds", measure.seconds, "How long to count, s")
      ->check(between(0.01, 3600.0))
      ->capture_default_str();
  measure_rain->add_option("--seed", measure.seed, "Which of all possible rains")->capture_default_str();

  auto* bake_app = app.add_subcommand("bake", "Compute a table from first principles");
  bake_app->require_subcommand(1);
  auto* bake_streaks =
      bake_app->add_subcommand("streaks", "Light along the streaks of oscillating drops, by tracing them");
  bake_streaks->add_option("--out", bake.out, "Where to (default: content/streaks.exr beside the program)")
      ->type_name("FILE.exr");
  bake_streaks->add_option("--picture", bake.picture, "Also a sheet of streaks to look at")->type_name("FILE.png");
  bake_streaks->add_flag("--fine", bake.fine, "Many more angles and rays: minutes instead of seconds");
  const auto nodes = [&](const char* name, int& value, int most, const char* meaning) {
    bake_streaks->add_option(name, value, meaning)->check(CLI::Range(2, most));
  };
  nodes("--views", bake.views, 181, "Elevations of the view, from -90 to 90 degrees");
  nodes("--lights", bake.lights, 181, "Elevations of the light, from -90 to 90 degrees");
  nodes("--azimuths", bake.azimuths, 181, "Azimuths of the light from the view, from 0 to 180 degrees");
  nodes("--along", bake.along, 256, "Places in one cycle of oscillation");
  nodes("--oscillations", bake.oscillations, 64, "Phases of mode (3,1) against (2,0)");
  nodes("--across", bake.across, 64, "Places across a streak");
  bake_streaks->add_option("--rays", bake.rays, "For each view and shape")->check(CLI::Range(100, 10000000));
  bake_streaks->add_option("--threads", bake.threads, "The same bytes with any number")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  bake_streaks->add_option("--diameter", bake.diameter_mm, "Of the drop, mm")
      ->check(between(0.1, 6.0))
      ->capture_default_str();
  bake_streaks->add_option("--prolate", bake.prolate, "Amplitude of mode (2,0), in radii")
      ->check(between(0.0, 0.25))
      ->capture_default_str();
  bake_streaks->add_option("--sideways", bake.sideways, "Amplitude of mode (3,1), in radii")
      ->check(between(0.0, 0.25))
      ->capture_default_str();
  bake_streaks->add_option("--exposure", bake.exposure_s, "Of the streaks on the sheet, s")
      ->check(between(1e-4, 1.0))
      ->capture_default_str();

  auto* info_app = app.add_subcommand("info", "Describe device, components, systems, passes and techniques");
  info_app->add_flag("--json", info.json, "As JSON");
  info_app->add_option("subject", info.subject, "Whose frame --graph draws (default: the city)")
      ->type_name("SCRIPT|MODEL");
  info_app->add_option("--graph", info.graph, "Write the frame's passes as Graphviz")->type_name("FILE.dot");
  info_app->add_option("--reference", info.reference, "Write the reference of components and scripts")
      ->type_name("FILE.md");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    parsed.exit_code = app.exit(error, std::cout, std::cerr) == 0 ? exit_done : exit_wrong_call;
    return parsed;
  }
  if (*play_app)
    parsed.options = play;
  else if (*render_app)
    parsed.options = render;
  else if (*bench_app)
    parsed.options = bench;
  else if (*chart_app)
    parsed.options = chart;
  else if (*measure_app)
    parsed.options = measure;
  else if (*bake_app)
    parsed.options = bake;
  else
    parsed.options = info;
  return parsed;
}

}  // namespace petrichor
