#include "engine/assets/image.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <type_traits>

namespace petrichor {
namespace {

constexpr std::uint64_t maximum_pixel_bytes = 1ull << 30;  // of one image, decoded

bool starts_with(std::span<const std::uint8_t> bytes, std::string_view magic, std::size_t offset = 0) {
  return bytes.size() >= offset + magic.size() && std::memcmp(bytes.data() + offset, magic.data(), magic.size()) == 0;
}

// The format by its content, as the specification asks for (section 3.8.3); few on purpose, since each
// decoder is one more that strangers' files reach.
const char* extension_of(std::span<const std::uint8_t> bytes) {
  using namespace std::string_view_literals;
  if (starts_with(bytes, "\x89PNG\r\n\x1a\n"sv)) return "png";
  if (starts_with(bytes, "\xff\xd8\xff"sv)) return "jpg";
  if (starts_with(bytes, "RIFF"sv) && starts_with(bytes, "WEBP"sv, 8)) return "webp";
  if (starts_with(bytes, "BM"sv)) return "bmp";
  if (starts_with(bytes, "II*\0"sv) || starts_with(bytes, "MM\0*"sv)) return "tif";
  if (starts_with(bytes, "#?RADIANCE"sv) || starts_with(bytes, "#?RGBE"sv)) return "hdr";
  if (starts_with(bytes, "\x76\x2f\x31\x01"sv)) return "exr";
  return nullptr;
}

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ';');
  return text;
}

// For decoders that read files only.
struct TemporaryFile {
  std::filesystem::path path;
  TemporaryFile(std::span<const std::uint8_t> bytes, const char* extension) {
    std::random_device random;
    path = std::filesystem::temp_directory_path() /
           fmt::format("petrichor-{:08x}{:08x}.{}", random(), random(), extension);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

// Reads into texels of four, in place: a second copy of a large image could be a gigabyte.
template <class T>
bool read_texels(OIIO::ImageInput& input, OIIO::TypeDesc type, int channels, T opaque, std::size_t texels,
                 std::vector<std::uint8_t>& pixels) {
  pixels.resize(texels * 4 * sizeof(T));
  if (!input.read_image(0, 0, 0, channels, type, pixels.data(), 4 * sizeof(T))) return false;
  for (std::size_t i = 0; i < texels; ++i) {
    T in[4];
    std::memcpy(in, pixels.data() + i * sizeof(in), sizeof(in));
    if constexpr (std::is_floating_point_v<T>) {
      for (T& value : in) value = std::isfinite(value) ? value : T{0};
    }
    const bool colour = channels >= 3;
    const T alpha = channels == 2 ? in[1] : channels == 4 ? in[3] : opaque;
    const T out[4] = {in[0], colour ? in[1] : in[0], colour ? in[2] : in[0], alpha};
    std::memcpy(pixels.data() + i * sizeof(out), out, sizeof(out));
  }
  return true;
}

Result<Image> read_pixels(OIIO::ImageInput& input, const std::string& name) {
  const OIIO::ImageSpec spec = input.spec();
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1) {
    return failure("no two-dimensional image");
  }
  if (spec.width > maximum_image_side || spec.height > maximum_image_side) {
    return failure(
        fmt::format("{} x {} pixels, at most {} a side are read", spec.width, spec.height, maximum_image_side));
  }
  const bool is_float = spec.format.is_floating_point();
  const std::uint64_t texels = static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
  const int channels = std::min(spec.nchannels, 4);
  if (texels * 4 * (is_float ? 4 : 1) > maximum_pixel_bytes) {
    return failure(fmt::format("{} x {} pixels need more than {} bytes", spec.width, spec.height, maximum_pixel_bytes));
  }
  Image image;
  image.width = spec.width;
  image.height = spec.height;
  image.is_float = is_float;
  image.name = name;
  const bool done = is_float
                        ? read_texels(input, OIIO::TypeDesc::FLOAT, channels, 1.0f, texels, image.pixels)
                        : read_texels(input, OIIO::TypeDesc::UINT8, channels, std::uint8_t{255}, texels, image.pixels);
  if (!done) return failure(fmt::format("the image cannot be decoded: {}", one_line(input.geterror())));
  return image;
}

Result<Image> decode(std::span<const std::uint8_t> bytes, const std::string& name) {
  const char* extension = extension_of(bytes);
  if (extension == nullptr) {
    return failure(
        fmt::format("{} bytes that are no image; PNG, JPEG, WebP, BMP, TIFF, HDR and EXR are read", bytes.size()));
  }
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(bytes.data()), bytes.size());
  std::unique_ptr<TemporaryFile> file;
  auto input = OIIO::ImageInput::create(extension);  // by format, no file is touched
  if (!input)
    return failure(fmt::format("this OpenImageIO reads no .{} files: {}", extension, one_line(OIIO::geterror())));
  OIIO::ImageSpec spec;
  bool opened = false;
  if (input->supports("ioproxy")) {
    input->set_ioproxy(&memory);
    opened = input->open(fmt::format("image.{}", extension), spec, hints);
  } else {
    file = std::make_unique<TemporaryFile>(bytes, extension);
    opened = input->open(file->path.string(), spec, hints);
  }
  if (!opened) return failure(fmt::format("the image cannot be read: {}", one_line(input->geterror())));
  return read_pixels(*input, name);
}

}  // namespace

Result<Image> decode_image(std::span<const std::uint8_t> bytes, const std::string& name) {
  try {
    return decode(bytes, name);
  } catch (const std::bad_alloc&) {
    return failure("not enough memory for the image");
  } catch (const std::exception& error) {
    return failure(fmt::format("the image cannot be decoded: {}", error.what()));
  }
}

}  // namespace petrichor
