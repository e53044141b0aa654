#include "systems/puddle/street.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

namespace petrichor {
namespace {

double ground(double x, double z) {
  const auto bell = [](double d, double width) { return std::exp(-d * d / (width * width)); };
  double h = 0.008 * x + 0.003 * z;  // falls towards a corner
  h -= 0.011 * (bell(z - 2.2, 0.28) + bell(z - 3.7, 0.28));
  h += 0.004 * std::sin(1.9 * x + 0.7) * std::sin(1.3 * z + 0.2) + 0.0025 * std::sin(4.3 * x + 1.1 * z) +
       0.0012 * std::sin(9.1 * z - 5.3 * x + 0.5) + 0.0006 * std::sin(21.0 * x + 3.0) * std::sin(17.0 * z);
  constexpr std::array<std::array<double, 5>, 6> settled{{{1.8, 1.1, 0.6, 0.4, 0.022},
                                                          {5.6, 1.5, 0.9, 0.5, 0.028},
                                                          {3.7, 4.9, 0.7, 0.5, 0.024},
                                                          {6.6, 4.6, 0.4, 0.7, 0.030},
                                                          {2.0, 3.7, 0.8, 0.3, 0.018},
                                                          {4.6, 2.2, 0.7, 0.3, 0.016}}};
  for (const auto& s : settled)
    h -= s[4] * std::exp(-std::pow((x - s[0]) / s[2], 2.0) - std::pow((z - s[1]) / s[3], 2.0));
  return h;
}

}  // namespace

StreetPatch make_street_patch() {
  StreetPatch p;
  p.width = 320;
  p.height = 240;
  const auto count = static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height);
  const auto at = [&](int i, int j) { return static_cast<std::size_t>(j) * 320u + static_cast<std::size_t>(i); };
  p.ground_m.resize(count);
  for (int j = 0; j < p.height; ++j)
    for (int i = 0; i < p.width; ++i) p.ground_m[at(i, j)] = ground((i + 0.5) * p.cell_m, (j + 0.5) * p.cell_m);

  // Priority-Flood (Barnes, Lehman, Mulla 2014, algorithm 1), and where each cell's water goes.
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::vector<double> level = p.ground_m;
  std::vector<char> closed(count, 0);
  std::vector<std::size_t> downhill(count), order;
  for (int j = 0; j < p.height; ++j)
    for (int i = 0; i < p.width; ++i) {
      if (i > 0 && j > 0 && i + 1 < p.width && j + 1 < p.height) continue;
      closed[at(i, j)] = 1;
      downhill[at(i, j)] = at(i, j);
      open.emplace(p.ground_m[at(i, j)], at(i, j));
    }
  const auto each_neighbour = [&](std::size_t k, auto&& visit) {
    const int i = static_cast<int>(k % 320u), j = static_cast<int>(k / 320u);
    for (int b = std::max(j - 1, 0); b <= std::min(j + 1, p.height - 1); ++b)
      for (int a = std::max(i - 1, 0); a <= std::min(i + 1, p.width - 1); ++a) visit(at(a, b));
  };
  while (!open.empty()) {
    const auto [from, k] = open.top();
    open.pop();
    order.push_back(k);
    each_neighbour(k, [&, from = from, k = k](std::size_t m) {
      if (closed[m]) return;
      closed[m] = 1;
      downhill[m] = k;
      level[m] = std::max(p.ground_m[m], from);
      open.emplace(level[m], m);
    });
  }
  p.hollow_of.assign(count, -1);
  for (const std::size_t start : order) {
    if (p.hollow_of[start] >= 0 || level[start] <= p.ground_m[start]) continue;
    const int number = static_cast<int>(p.hollows.size());
    StreetHollow hollow;
    hollow.brim_m = level[start];
    // Followed downhill from the cell that the flood came in by.
    for (std::size_t k = start; hollow.spills_into < 0 && downhill[k] != k;) {
      k = downhill[k];
      hollow.spills_into = p.hollow_of[k];
    }
    std::vector<std::size_t> stack{start};
    p.hollow_of[start] = number;
    while (!stack.empty()) {
      const std::size_t k = stack.back();
      stack.pop_back();
      hollow.cells.push_back(k);
      each_neighbour(k, [&](std::size_t m) {
        if (p.hollow_of[m] >= 0 || level[m] <= p.ground_m[m] || level[m] != hollow.brim_m) return;
        p.hollow_of[m] = number;
        stack.push_back(m);
      });
    }
    std::sort(hollow.cells.begin(), hollow.cells.end(),
              [&](std::size_t a, std::size_t b) { return p.ground_m[a] < p.ground_m[b]; });
    for (const std::size_t k : hollow.cells) hollow.heights_m.push_back(p.ground_m[k]);
    hollow.deepest_m = hollow.heights_m.front();
    p.hollows.push_back(std::move(hollow));
  }
  std::vector<double> runoff(count, p.cell_m * p.cell_m);
  for (auto k = order.rbegin(); k != order.rend(); ++k) {
    if (p.hollow_of[*k] >= 0)
      p.hollows[static_cast<std::size_t>(p.hollow_of[*k])].catchment_m2 += runoff[*k];
    else if (downhill[*k] != *k)
      runoff[downhill[*k]] += runoff[*k];
  }
  return p;
}

StreetTruth::StreetTruth(const StreetPatch& patch) : patch_(patch) {
  const double cell_m2 = patch.cell_m * patch.cell_m;
  for (const StreetHollow& h : patch.hollows) {
    volumes_.push_back(0.0);
    levels_.push_back(h.deepest_m);
    std::vector<double> below{0.0};
    for (std::size_t i = 1; i < h.heights_m.size(); ++i)
      below.push_back(below.back() + cell_m2 * static_cast<double>(i) * (h.heights_m[i] - h.heights_m[i - 1]));
    below_.push_back(std::move(below));
  }
}

void StreetTruth::find_level(std::size_t n) {
  const auto above = std::upper_bound(below_[n].begin(), below_[n].end(), volumes_[n]);
  const auto wet = static_cast<std::size_t>(above - below_[n].begin());  // cells under water
  levels_[n] = patch_.hollows[n].heights_m[wet - 1] +
               (volumes_[n] - below_[n][wet - 1]) / (patch_.cell_m * patch_.cell_m * static_cast<double>(wet));
}

void StreetTruth::advance(double duration_s, double step_s, double rain_mps, double loss_mps) {
  const double cell_m2 = patch_.cell_m * patch_.cell_m;
  const auto steps = static_cast<int>(std::lround(duration_s / step_s));
  for (int step = 0; step < steps; ++step) {
    std::vector<double> spilled(patch_.hollows.size(), 0.0);
    for (std::size_t n = patch_.hollows.size(); n-- > 0;) {  // what spills goes to a smaller number, in the same step
      const StreetHollow& h = patch_.hollows[n];
      const double in = h.catchment_m2 * rain_mps * step_s;
      const auto wet = std::upper_bound(below_[n].begin(), below_[n].end(), volumes_[n]) - below_[n].begin();
      const double available = volumes_[n] + in + spilled[n];
      const double out = std::min(loss_mps * step_s * cell_m2 * static_cast<double>(wet), available);
      const double full =
          below_[n].back() + cell_m2 * static_cast<double>(h.cells.size()) * (h.brim_m - h.heights_m.back());
      volumes_[n] = available - out;
      const double over = std::max(volumes_[n] - full, 0.0);
      volumes_[n] -= over;
      (h.spills_into >= 0 ? spilled[static_cast<std::size_t>(h.spills_into)] : left_m3) += over;
      arrived_m3 += in;
      lost_m3 += out;
    }
  }
  for (std::size_t n = 0; n < patch_.hollows.size(); ++n) find_level(n);
}

double StreetTruth::stored_m3() const {
  double sum = 0.0;
  for (const double v : volumes_) sum += v;
  return sum;
}

}  // namespace petrichor
