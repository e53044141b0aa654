#include "engine/app/recorder.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "engine/app/film.hpp"
#include "engine/core/paths.hpp"

namespace petrichor {
namespace {

namespace fs = std::filesystem;

Result<void> make_folder_of(const fs::path& file) {
  std::error_code error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  if (error)
    return failure(fmt::format("{}: cannot make the folder: {}", file.parent_path().string(), error.message()));
  return {};
}

class PictureRecorder final : public Recorder {
 public:
  explicit PictureRecorder(RecordTarget target) : target_(std::move(target)) {}

  Result<void> add(std::int64_t number, const Picture& picture) override {
    const fs::path file = target_.numbered ? numbered_file(target_.file, number) : target_.file;
    if (auto made = make_folder_of(file); !made) return made;
    std::vector<unsigned char> bytes;
    if (auto encoded = encode(picture, bytes); !encoded)
      return failure(fmt::format("{}: cannot be encoded: {}", file.string(), encoded.error().message));
    return write_whole_file(file, std::as_bytes(std::span(bytes)));
  }

  Result<void> finish() override { return {}; }

 private:
  Result<void> encode(const Picture& picture, std::vector<unsigned char>& bytes) {
    const bool exr = target_.kind == RecordKind::exr;
    const char* format = exr ? "picture.exr" : "picture.png";
    OIIO::Filesystem::IOVecOutput memory(bytes);
    auto output = OIIO::ImageOutput::create(format, &memory);
    if (!output) return failure(OIIO::geterror());
    OIIO::ImageSpec spec(picture.width, picture.height, 3, exr ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", exr ? "Linear" : "sRGB");
    if (exr) spec.attribute("compression", "zip");
    if (!output->open(format, spec)) return failure(output->geterror());
    const auto write_rows = [&](const auto* data, OIIO::TypeDesc type) {
      // OpenGL's rows start at the bottom: begin with the last one and walk back.
      const auto texel = static_cast<OIIO::stride_t>(4 * sizeof(*data));
      const auto row = texel * picture.width;
      return output->write_image(type, data + static_cast<std::ptrdiff_t>(picture.height - 1) * picture.width * 4,
                                 texel, -row);
    };
    const bool good = exr ? write_rows(picture.rgba32f.data(), OIIO::TypeDesc::FLOAT)
                          : write_rows(picture.rgba8.data(), OIIO::TypeDesc::UINT8);
    if (!output->close() || !good) return failure(output->geterror());
    return {};
  }

  RecordTarget target_;
};

}  // namespace

fs::path numbered_file(const fs::path& pattern, std::int64_t number) {
  const std::string text = pattern.string();
  const auto percent = text.find('%');
  const auto d = text.find('d', percent);
  const std::string digits = text.substr(percent + 1, d - percent - 1);
  const int width = digits.empty() ? 0 : std::stoi(digits);
  return text.substr(0, percent) + fmt::format("{:0{}}", number, width) + text.substr(d + 1);
}

Result<RecordTarget> record_target(const fs::path& out, std::int64_t frames) {
  std::string extension = out.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  RecordTarget target{RecordKind::png, out, false};
  if (extension == ".png")
    target.kind = RecordKind::png;
  else if (extension == ".exr")
    target.kind = RecordKind::exr;
  else if (extension == ".mp4" || extension == ".mkv" || extension == ".webm" || extension == ".mov")
    target.kind = RecordKind::film;
  else
    return wrong_call(
        fmt::format("--out {}: cannot tell the kind of file; use .png, .exr, .mp4, .mkv, .webm or .mov", out.string()));

  const std::string text = out.string();
  const auto percent = text.find('%');
  if (percent != std::string::npos) {
    const auto d = text.find_first_not_of("0123456789", percent + 1);
    const bool good =
        d != std::string::npos && text[d] == 'd' && d - percent <= 3 && text.find('%', d) == std::string::npos;
    if (!good) return wrong_call(fmt::format("--out {}: the frame number's place is written %d or %04d, once", text));
    if (target.kind == RecordKind::film)
      return wrong_call(fmt::format("--out {}: a film is one file; leave out the %d", text));
    target.numbered = true;
  } else if (target.kind != RecordKind::film && frames > 1) {
    return wrong_call(fmt::format(
        "--out {}: {} frames do not fit one picture; put %04d in the name, or ask for one frame with --frames A:B",
        text, frames));
  }
  if (fs::is_directory(out)) return wrong_call(fmt::format("--out {}: is a folder; name a file", text));
  return target;
}

Result<std::unique_ptr<Recorder>> make_recorder(const RecordTarget& target, int width, int height, double fps) {
  if (auto made = make_folder_of(target.file); !made) return tl::unexpected(made.error());
  if (target.kind == RecordKind::film) return make_film_recorder(target.file, width, height, fps);
  return std::make_unique<PictureRecorder>(target);
}

}  // namespace petrichor
