#pragma once
#include <filesystem>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

// Puts the chart's figures (content/ladders.csv: effect,rung,ms,error,stable) in place of those that the ladders bring.
// Lines that begin with # are remarks, the first other line is the heading; stable is 1 or 0. Rungs that the table does
// not name keep what they have. Errors name the line.
Result<void> read_ladder_figures(std::string_view csv, std::string_view name, std::vector<Ladder>&);
Result<void> load_ladder_figures(const std::filesystem::path&, std::vector<Ladder>&);

}  // namespace petrichor
