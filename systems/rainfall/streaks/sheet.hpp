#pragma once
// The streak table as a picture, for people.

#include <string>

#include "systems/rainfall/streaks/table.hpp"

namespace petrichor {

// Streaks over the table's exposure, each as bright as its brightest place allows. Columns: azimuths of the lamp from 0
// (it stands behind the eye) to 180 degrees (behind the drop). Rows: elevations of the lamp of 60, 20, -20 and -60
// degrees, seen from the drop's height, then from 60 degrees above. Two drops of other phases each. PNG, 8 bits.
Result<void> write_streak_sheet(const std::string& file, const StreakTable&);

}  // namespace petrichor
