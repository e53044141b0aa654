// Petrichor: the composition root. From here everything is seen, and the program reads top to bottom:
// the command line -> one of the commands in engine/main/ -> a World (components and systems) that fills a
// Frame -> a Renderer (passes) that draws it. The list of systems is systems/systems.cpp, the frame's order
// scripts/render/city.lua, the main loop engine/main/play.cpp.

#include <exception>

#include "engine/app/interrupt.hpp"
#include "engine/app/options.hpp"
#include "engine/core/log.hpp"
#include "engine/main/commands.hpp"

using namespace petrichor;

namespace {

struct Run {
  Result<void> operator()(const PlayOptions& options) const { return play(options); }
  Result<void> operator()(const RenderOptions& options) const { return render(options); }
  Result<void> operator()(const BenchOptions& options) const { return bench(options); }
  Result<void> operator()(const ChartOptions& options) const { return chart(options); }
  Result<void> operator()(const MeasureOptions& options) const { return measure(options); }
  Result<void> operator()(const BakeOptions& options) const { return bake(options); }
  Result<void> operator()(const InfoOptions& options) const { return info(options); }
};

}  // namespace

int main(int argc, char** argv) try {
  const ParsedCommandLine call = parse_command_line(argc, argv);
  if (!call.options) return call.exit_code;
  if (call.verbose) set_log_level(LogLevel::debug);
  const Result<void> done = std::visit(Run{}, *call.options);
  if (done) return exit_done;
  log_error("{}", done.error().message);
  end_if_interrupted();
  return done.error().wrong_call ? exit_wrong_call : exit_failed;
} catch (const std::exception& exception) {
  // Nothing is expected to throw; what does (no memory left) still ends with a message.
  log_error("{}", exception.what());
  return exit_failed;
}
