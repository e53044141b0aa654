#pragma once
// What the program can be asked to do: one function a subcommand. Errors come back to main(), which prints them.

#include "engine/app/options.hpp"
#include "engine/core/result.hpp"

namespace petrichor {

Result<void> play(const PlayOptions&);
Result<void> render(const RenderOptions&);
Result<void> bench(const BenchOptions&);
Result<void> chart(const ChartOptions&);
Result<void> measure(const MeasureOptions&);
Result<void> bake(const BakeOptions&);
Result<void> info(const InfoOptions&);

}  // namespace petrichor
