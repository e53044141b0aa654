#include "systems/rainfall/streaks/sheet.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "engine/core/paths.hpp"
#include "systems/rainfall/streaks/drop_shape.hpp"

namespace petrichor {
namespace {

constexpr int streak_width = 22, streak_height = 132, gap = 5, columns = 10;
constexpr double drift = 1.9364916731037085 - 2.0;  // of mode (3,1) against twice mode (2,0), each cycle

struct Sheet {
  int width, height;
  std::vector<unsigned char> grey;
};

void draw_streak(Sheet& sheet, int left, int top, const StreakTable& t, const StreakAngles& angles, double phase) {
  const double cycles = oscillation_frequency_hz(2, t.drop.diameter_mm) * t.drop.exposure_s;
  std::vector<double> light(std::size_t(streak_width) * streak_height);
  double most = 1e-12;
  for (int y = 0; y < streak_height; ++y) {
    const double along = cycles * y / streak_height;
    const double m = streak_modulation(t, angles, along, phase + drift * along);
    for (int x = 0; x < streak_width; ++x) {
      const double across = -1.0 + 2.0 * (x + 0.5) / streak_width;
      double& v = light[std::size_t(y) * streak_width + x];
      v = m * streak_profile(t, angles, across) * std::sqrt(1.0 - across * across);
      most = std::max(most, v);
    }
  }
  for (int y = 0; y < streak_height; ++y)
    for (int x = 0; x < streak_width; ++x)
      sheet.grey[std::size_t(top + y) * sheet.width + left + x] = static_cast<unsigned char>(
          std::lround(255.0 * std::pow(light[std::size_t(y) * streak_width + x] / most, 1.0 / 2.2)));
}

}  // namespace

Result<void> write_streak_sheet(const std::string& file, const StreakTable& table) {
  constexpr double degree = std::numbers::pi / 180.0;
  constexpr double views[] = {0.0, 60.0}, lights[] = {60.0, 20.0, -20.0, -60.0};
  const int across = 2 * (streak_width + gap) + 2 * gap, down = streak_height + 2 * gap;
  Sheet sheet{columns * across, 8 * down, {}};
  sheet.grey.assign(std::size_t(sheet.width) * sheet.height, 12);
  int row = 0;
  for (const double view : views)
    for (const double light : lights) {
      for (int c = 0; c < columns; ++c)
        for (int twin = 0; twin < 2; ++twin)
          draw_streak(sheet, c * across + gap + twin * (streak_width + gap), row * down + gap, table,
                      {view * degree, light * degree, 180.0 * c / (columns - 1) * degree}, 0.37 * twin);
      ++row;
    }
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto out = OIIO::ImageOutput::create("png");
  if (!out || !out->set_ioproxy(&memory) ||
      !out->open(file, OIIO::ImageSpec(sheet.width, sheet.height, 1, OIIO::TypeDesc::UINT8)) ||
      !out->write_image(OIIO::TypeDesc::UINT8, sheet.grey.data()) || !out->close())
    return failure(fmt::format("{}: {}", file, out ? out->geterror() : OIIO::geterror()));
  return write_whole_file(file, std::as_bytes(std::span(bytes)));
}

}  // namespace petrichor
