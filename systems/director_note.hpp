#pragma once
// What the director has to say about one effect: for the overlay and for --stats.

#include <string>

namespace petrichor {

struct DirectorNote {
  std::string effect;
  std::string rung;
  double ms = 0.0;        // what the rung is thought to cost at the size that is drawn; of `resolution`: all the rest
  double error = 0.0;     // the effect left out: 1
  double coverage = 0.0;  // of the picture
  int switches = 0;
  std::string why;  // "double_cone: drop_field would need 18.2 ms, 6.1 are left"
};

}  // namespace petrichor
