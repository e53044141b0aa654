#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "systems/drops/drop_optics.hpp"
#include "systems/rainfall/streaks/drop_shape.hpp"
#include "systems/rainfall/streaks/table.hpp"

namespace petrichor {
namespace {

constexpr int version = 2;
constexpr const char* advice = "bake it anew: petrichor bake streaks --out FILE.exr";

struct Part {
  const char* name;
  int width;
  int height;
  const std::vector<float>* values;
};

constexpr int part_count = 4;
std::array<Part, part_count> parts_of(const StreakTable& t) {
  const int entries = t.grid.entries();
  return {{{"modulation", t.oscillations * t.along, entries, &t.modulation},
           {"profile", t.across, entries, &t.profile},
           {"mean", 1, entries, &t.mean},
           {"phase", drop_phase_bins, 1, &t.phase}}};
}

OIIO::ImageSpec spec_of(const StreakTable& t, const Part& part) {
  OIIO::ImageSpec spec(part.width, part.height, 1, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"Y"};
  spec.full_width = t.oscillations * t.along;  // OpenEXR wants the same of all images of a file
  spec.full_height = t.grid.entries();
  const auto number = [&](const char* name, double value) {
    spec.attribute(std::string("petrichor:") + name, float(value));
  };
  const auto whole = [&](const char* name, int value) { spec.attribute(std::string("petrichor:") + name, value); };
  spec.attribute("oiio:subimagename", part.name);
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // or OpenImageIO writes today, and no two bakes are the same
  spec.attribute(
      "ImageDescription",
      "Streaks of an oscillating drop. Row (view * light nodes + light) * azimuth nodes + azimuth; elevations "
      "-90 to 90, azimuth 0 to 180 degrees. Radiance per irradiance (1/sr) = "
      "phase * mean * modulation * profile; phase by sin(turn / 2), the last two have mean 1.");
  whole("streak_table", version);
  whole("view_nodes", t.grid.view);
  whole("light_nodes", t.grid.light);
  whole("azimuth_nodes", t.grid.azimuth);
  whole("along", t.along);
  whole("oscillations", t.oscillations);
  whole("across", t.across);
  whole("rays", t.rays);
  number("diameter_mm", t.drop.diameter_mm);
  number("amplitude_20", t.drop.prolate);
  number("amplitude_31", t.drop.sideways);
  number("lean_deg", t.drop.lean_deg);
  number("exposure_s", t.drop.exposure_s);
  const double f2 = oscillation_frequency_hz(2, t.drop.diameter_mm);
  number("frequency_2_hz", f2);
  number("frequency_3_hz", oscillation_frequency_hz(3, t.drop.diameter_mm));
  number("bands_per_exposure", f2 * t.drop.exposure_s);
  return spec;
}

// Only what a bake can have made.
bool sensible(const StreakTable& t) {
  const auto between = [](int value, int low, int high) { return value >= low && value <= high; };
  return between(t.grid.view, 2, 256) && between(t.grid.light, 2, 256) && between(t.grid.azimuth, 2, 256) &&
         between(t.along, 1, 1024) && between(t.oscillations, 1, 256) && between(t.across, 1, 256);
}

}  // namespace

Result<void> write_streak_table(const std::string& file, const StreakTable& table) {
  if (std::filesystem::path(file).extension() != ".exr")
    return wrong_call(fmt::format("{}: a streak table is an OpenEXR file; give it a name that ends in .exr", file));
  const auto out = OIIO::ImageOutput::create("exr");
  if (!out) return failure(fmt::format("{}: OpenImageIO cannot write OpenEXR: {}", file, OIIO::geterror()));
  // Beside the target and renamed when whole; OpenImageIO writes several images to a real file only.
  const std::filesystem::path target(file);
  std::filesystem::path beside = target;
  beside.replace_filename("." + target.stem().string() + ".part.exr");
  std::error_code error;
  if (target.has_parent_path()) std::filesystem::create_directories(target.parent_path(), error);
  const std::array<Part, part_count> parts = parts_of(table);
  std::vector<OIIO::ImageSpec> specs;
  for (const Part& part : parts) specs.push_back(spec_of(table, part));
  const auto failed = [&](const std::string& why) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    return failure(fmt::format("cannot write {}: {}; choose a folder that you may write to", file, why));
  };
  if (!out->open(beside.string(), static_cast<int>(specs.size()), specs.data())) return failed(out->geterror());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0 && !out->open(beside.string(), specs[i], OIIO::ImageOutput::AppendSubimage))
      return failed(out->geterror());
    if (!out->write_image(OIIO::TypeDesc::FLOAT, parts[i].values->data())) return failed(out->geterror());
  }
  if (!out->close()) return failed(out->geterror());
  std::filesystem::rename(beside, target, error);
  if (error) return failed(error.message());
  return {};
}

Result<StreakTable> load_streak_table(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    return failure(fmt::format("{}: there is no such streak table; {}", file, advice));
  const auto in = OIIO::ImageInput::open(file);
  if (!in) {
    const std::string why = OIIO::geterror();
    return failure(fmt::format("{}: not a streak table that can be read ({}); {}", file, why, advice));
  }
  StreakTable t;
  const OIIO::ImageSpec& spec = in->spec();
  const auto whole = [&](const char* name) { return spec.get_int_attribute(std::string("petrichor:") + name, 0); };
  const auto number = [&](const char* name) {
    return spec.get_float_attribute(std::string("petrichor:") + name, 0.0f);
  };
  if (whole("streak_table") != version)
    return failure(fmt::format("{}: this picture is no streak table of version {}; {}", file, version, advice));
  t.grid = {whole("view_nodes"), whole("light_nodes"), whole("azimuth_nodes")};
  t.along = whole("along");
  t.oscillations = whole("oscillations");
  t.across = whole("across");
  t.rays = whole("rays");
  t.drop = {number("diameter_mm"), number("amplitude_20"), number("amplitude_31"), number("lean_deg"),
            number("exposure_s")};
  if (!sensible(t)) return failure(fmt::format("{}: its sizes make no sense; {}", file, advice));
  const std::array<Part, part_count> parts = parts_of(t);
  const std::array<std::vector<float>*, part_count> values{&t.modulation, &t.profile, &t.mean, &t.phase};
  for (int i = 0; i < part_count; ++i) {
    if (!in->seek_subimage(i, 0) || in->spec().width != parts[i].width || in->spec().height != parts[i].height ||
        in->spec().nchannels != 1)
      return failure(fmt::format("{}: image '{}' is missing or has another size than the table says; {}", file,
                                 parts[i].name, advice));
    values[i]->resize(std::size_t(parts[i].width) * parts[i].height);
    if (!in->read_image(i, 0, 0, 1, OIIO::TypeDesc::FLOAT, values[i]->data())) {
      const std::string why = in->geterror();
      return failure(fmt::format("{}: image '{}' cannot be read ({}); {}", file, parts[i].name, why, advice));
    }
    for (const float v : *values[i])
      if (!std::isfinite(v) || v < 0.0f || (values[i] == &t.mean && v == 0.0f))
        return failure(fmt::format("{}: image '{}' holds values that are no light; {}", file, parts[i].name, advice));
  }
  return t;
}

}  // namespace petrichor
