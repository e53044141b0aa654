// bench, chart, measure and info: the program's read-outs.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "components/components.hpp"
#include "engine/app/progress.hpp"
#include "engine/core/bench_row.hpp"
#include "engine/core/log.hpp"
#include "engine/core/paths.hpp"
#include "engine/ecs/bench_ecs.hpp"
#include "engine/ecs/schema_reference.hpp"
#include "engine/main/commands.hpp"
#include "engine/main/renderer.hpp"
#include "engine/main/world.hpp"
#include "engine/script/reference.hpp"
#include "systems/drip/chart.hpp"
#include "systems/rainfall/bench.hpp"
#include "systems/rainfall/bench_rungs.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/splash/splash.hpp"
#include "systems/rainfall/measure.hpp"
#include "systems/rainfall/near_drops/near_chart.hpp"
#include "systems/rainfall/sprites/bench.hpp"
#include "systems/splatter/bench.hpp"
#include "systems/ripple/bench.hpp"
#include "systems/reflection/reflection.hpp"

namespace petrichor {
namespace {

nlohmann::ordered_json number_or_text(const std::string& text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size()) return value;
  return text;
}

nlohmann::ordered_json to_json(const std::vector<BenchRow>& rows) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const BenchRow& row : rows) {
    nlohmann::ordered_json item = {{"name", row.name},
                                   {"n", number_or_text(row.n)},
                                   {"size", row.size},
                                   {"median", row.median_ms},
                                   {"p95", row.p95_ms}};
    if (row.gpu_median_ms) item["gpu_median"] = *row.gpu_median_ms;
    array.push_back(std::move(item));
  }
  return array;
}

// One row a line: an array that people can read and programs too.
std::string row_lines(const nlohmann::ordered_json& array) {
  std::string text = "[";
  for (std::size_t i = 0; i < array.size(); ++i) text += (i ? ",\n " : "\n ") + array[i].dump();
  return text + "\n]\n";
}

// Which of the known names were asked for; all where none was.
Result<std::vector<std::string>> pick(const std::vector<std::string>& asked, const std::vector<std::string>& known,
                                      const char* what) {
  for (const std::string& name : asked)
    if (std::find(known.begin(), known.end(), name) == known.end())
      return wrong_call(fmt::format("no {} is called '{}'; there are: {}", what, name, fmt::join(known, ", ")));
  return asked.empty() ? known : asked;
}

FrameRain bench_rain_of(const Emitter& emitter, const Wind& wind, double time_s) {
  return make_frame_rain(emitter, start_rain_motion(emitter, wind), {}, 1, 1, time_s);
}

}  // namespace

Result<void> bench(const BenchOptions& options) {
  const auto names = pick(options.names, {"ecs", "rain", "rungs", "near_drops", "splashes", "drips", "reflections", "ripples", "tariq", "halos"}, "benchmark");
  if (!names) return tl::unexpected(names.error());
  std::vector<BenchRow> rows;
  for (const std::string& name : *names) {
    if (name == "ecs") {
      for (BenchRow& row : bench_ecs()) rows.push_back(std::move(row));
    } else {
      auto renderer = open_renderer(false, {});
      if (!renderer) return tl::unexpected(renderer.error());
      log_info("{}", (*renderer)->device.renderer);
      const bool software = (*renderer)->device.software;
      auto measured = name == "halos" ? bench_halos(options.width, options.height, options.frames, software)
                      : name == "tariq" ? bench_tariq(options.drops, options.width, options.height, options.frames, software)
                      : name == "near_drops" ? bench_near_drops(options.frames, software)
                      : name == "splashes" ? bench_splashes(options.width, options.height, options.frames, software,
                                                            bench_rain_of)
                      : name == "drips" ? bench_drips(options.width, options.height, options.frames, software)
                      : name == "ripples" ? bench_ripples(options.frames, software)
                      : name == "reflections" ? bench_reflections(all_passes, options.width, options.height, options.frames,
                                                                  software)
                      : name == "rungs" ? bench_rungs(options.width, options.height, options.frames, software,
                                                    affordable_drops((*renderer)->device))
                                      : bench_rain(options.drops, options.width, options.height, options.frames, software);
      if (!measured) return tl::unexpected(measured.error());
      for (BenchRow& row : *measured) rows.push_back(std::move(row));
    }
  }
  const std::string text = row_lines(to_json(rows));
  if (!options.json.empty()) return write_whole_file(options.json, text);
  std::fputs(text.c_str(), stdout);
  return {};
}

Result<void> chart(const ChartOptions& options) {
  if (!options.redraw.empty()) return redraw_charts(options.redraw);
  std::vector<std::string> known;
  for (const ChartOffer& offer : all_charts()) known.emplace_back(offer.name);
  const auto names = pick(options.effects, known, "chart");
  if (!names) return tl::unexpected(names.error());
  auto renderer = open_renderer(false, {});
  if (!renderer) return tl::unexpected(renderer.error());
  const DeviceInfo& device = (*renderer)->device;
  for (const std::string& name : *names)
    for (const ChartOffer& offer : all_charts()) {
      if (offer.name != name) continue;
      Progress progress("charting " + name, 1000);
      const auto advance = [&](double share) { progress.advance_to(static_cast<std::int64_t>(share * 1000.0)); };
      if (auto charted = offer.run({options.out, device.renderer, device.software, advance}); !charted) return charted;
    }
  log_info("charts are in {}", options.out.string());
  return {};
}

Result<void> measure(const MeasureOptions& options) {
  auto renderer = open_renderer(false, {});
  if (!renderer) return tl::unexpected(renderer.error());
  Progress progress("raining", 1000);
  const auto measured =
      measure_rain(options.rate_mm_per_hour, options.wind_mps, options.seconds, options.seed,
                   [&](double share) { progress.advance_to(static_cast<std::int64_t>(share * 1000.0)); });
  if (!measured) return tl::unexpected(measured.error());
  const nlohmann::ordered_json json = {{"asked_mm_per_hour", measured->asked_mm_per_hour},
                                       {"measured_mm_per_hour", measured->measured_mm_per_hour},
                                       {"drops_per_m3", measured->drops_per_m3},
                                       {"impacts_per_m2_s", measured->impacts_per_m2_s},
                                       {"mean_fall_speed_mps", measured->mean_fall_speed_mps},
                                       {"smaller_drops_mm_per_hour", measured->smaller_drops_mm_per_hour},
                                       {"drops_counted", measured->drops_counted},
                                       {"area_m2", measured->area_m2},
                                       {"wind_mps", options.wind_mps},
                                       {"seconds", options.seconds},
                                       {"seed", options.seed}};
  std::puts(json.dump(2).c_str());
  return {};
}

namespace {

nlohmann::ordered_json describe() {
  nlohmann::ordered_json all;
  all["version"] = PETRICHOR_VERSION;
  if (const auto context = make_headless_context({})) {
    const DeviceInfo device = (*context)->device();
    all["device"] = {{"renderer", device.renderer},
                     {"vendor", device.vendor},
                     {"version", device.version},
                     {"software", device.software}};
  } else {
    all["device"] = {{"error", context.error().message}};
  }
  for (const Schema& schema : component_schemas()) {
    nlohmann::ordered_json fields = nlohmann::ordered_json::array();
    for (const Field& field : schema.fields)
      fields.push_back({{"name", field.name}, {"unit", field.unit}, {"meaning", field.meaning}});
    all["components"].push_back({{"name", schema.name}, {"meaning", schema.meaning}, {"fields", fields}});
  }
  for (const auto& system : all_systems())
    all["systems"].push_back({{"name", system.name},
                              {"phase", phase_name(system.phase)},
                              {"reads", system.reads},
                              {"writes", system.writes}});
  for (const PassOffer& pass : all_passes()) {
    nlohmann::ordered_json slots = nlohmann::ordered_json::array();
    constexpr const char* access[] = {"read", "write", "modify"};
    for (const Slot& slot : pass.slots)
      slots.push_back(
          {{"name", slot.name}, {"access", access[static_cast<int>(slot.access)]}, {"optional", slot.optional}});
    all["passes"].push_back({{"name", pass.name}, {"meaning", pass.meaning}, {"slots", slots}});
  }
  for (const Ladder& ladder : all_ladders()) {
    nlohmann::ordered_json rungs = nlohmann::ordered_json::array();
    for (const Rung& rung : ladder.rungs)
      rungs.push_back({{"name", rung.name}, {"meaning", rung.meaning}, {"stable", rung.stable}});
    all["ladders"].push_back({{"effect", ladder.name},
                              {"meaning", ladder.meaning},
                              {"truth", ladder.truth},
                              {"error", ladder.error_measure},
                              {"default", ladder.rungs[Techniques()[ladder.effect].rung].name},
                              {"rungs", rungs}});
  }
  return all;
}

void print_for_people(const nlohmann::ordered_json& all) {
  const auto text = [](const nlohmann::ordered_json& value) { return value.get<std::string>(); };
  fmt::print("petrichor {}\n\nDevice\n", text(all["version"]));
  for (const auto& [key, value] : all["device"].items())
    fmt::print("  {}: {}\n", key, value.is_string() ? text(value) : value.dump());
  fmt::print("\nComponents\n");
  for (const auto& c : all["components"]) fmt::print("  {:<20} {}\n", text(c["name"]), text(c["meaning"]));
  fmt::print("\nSystems, in frame order\n");
  for (const auto& s : all["systems"]) fmt::print("  {:<20} {}\n", text(s["name"]), text(s["phase"]));
  fmt::print("\nPasses on offer\n");
  for (const auto& p : all["passes"]) fmt::print("  {:<20} {}\n", text(p["name"]), text(p["meaning"]));
  fmt::print("\nLadders: --technique EFFECT=RUNG, cheapest first\n");
  for (const auto& l : all["ladders"]) {
    fmt::print("  {}: {}\n", text(l["effect"]), text(l["meaning"]));
    for (const auto& r : l["rungs"])
      fmt::print("    {:<24} {}{}\n", text(l["effect"]) + "=" + text(r["name"]), text(r["meaning"]),
                 r["name"] == l["default"] ? " (default)" : "");
  }
}

Result<void> write_graph(const InfoOptions& options) {
  auto opened = open_renderer(false, {});
  if (!opened) return tl::unexpected(opened.error());
  Renderer& renderer = **opened;
  SubjectOptions subject;
  subject.subject = options.subject.empty() ? "scripts/scenes/city.lua" : options.subject;
  auto world = World::open(subject, renderer.scene.get());
  if (!world) return tl::unexpected(world.error());
  if (auto loaded = load_render_script(renderer, (*world)->render_script()); !loaded) return loaded;
  Frame frame;
  (*world)->extract(frame, 0, 0.0, 320, 180);
  if (auto drawn = draw(renderer, frame, false); !drawn) return tl::unexpected(drawn.error());
  return write_whole_file(options.graph, renderer.graph->dot());
}

}  // namespace

Result<void> info(const InfoOptions& options) {
  if (!options.reference.empty())
    return write_whole_file(options.reference, script_reference() + "\n" + schema_reference(component_schemas()));
  if (!options.graph.empty()) return write_graph(options);
  const auto all = describe();
  if (options.json)
    std::puts(all.dump(2).c_str());
  else
    print_for_people(all);
  return {};
}

}  // namespace petrichor
