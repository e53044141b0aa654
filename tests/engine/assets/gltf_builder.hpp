#pragma once
// Writes glTF files piece by piece, right or wrong as a test wants them.

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"

namespace petrichor::testing_gltf {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

inline constexpr int int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126;

inline std::string base64(const Bytes& bytes) {
  static const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? letters[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

inline void write_file(const std::filesystem::path& file, const Bytes& bytes) {
  std::error_code ignored;
  std::filesystem::remove(file, ignored);  // ext4 waits for the disk where a file is written over
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}
inline void write_file(const std::filesystem::path& file, const std::string& text) {
  write_file(file, Bytes(text.begin(), text.end()));
}

template <class T>
Bytes bytes_of(const std::vector<T>& values) {
  Bytes out(values.size() * sizeof(T));
  std::memcpy(out.data(), values.data(), out.size());
  return out;
}

inline void append_u32(Bytes& out, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

struct Builder {
  json root = {{"asset", {{"version", "2.0"}}}};
  Bytes bin;

  template <class T>
  int view(const std::vector<T>& values, int stride = 0) {
    bin.resize((bin.size() + 3) / 4 * 4);
    json view = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride != 0) view["byteStride"] = stride;
    const Bytes bytes = bytes_of(values);
    bin.insert(bin.end(), bytes.begin(), bytes.end());
    root["bufferViews"].push_back(view);
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }

  int accessor(json accessor) {
    root["accessors"].push_back(std::move(accessor));
    return static_cast<int>(root["accessors"].size()) - 1;
  }

  // A tightly packed accessor of its own view.
  template <class T>
  int data(const std::vector<T>& values, int component_type, const std::string& type, std::size_t components,
           bool normalized = false) {
    json a = {{"bufferView", view(values)},
              {"componentType", component_type},
              {"type", type},
              {"count", values.size() / components}};
    if (normalized) a["normalized"] = true;
    return accessor(a);
  }

  int positions(const std::vector<float>& xyz) { return data(xyz, float32, "VEC3", 3); }

  int mesh(json primitive) {
    root["meshes"].push_back({{"primitives", json::array({std::move(primitive)})}});
    return static_cast<int>(root["meshes"].size()) - 1;
  }

  int node(json node) {
    root["nodes"].push_back(std::move(node));
    return static_cast<int>(root["nodes"].size()) - 1;
  }

  // The triangle (0,0,0) (1,0,0) (0,1,0), seen from +z, on one node.
  static Builder triangle() {
    Builder b;
    const int position = b.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", position}}}})}});
    return b;
  }

  json& primitive() { return root["meshes"][0]["primitives"][0]; }

  std::string gltf() const {
    json out = root;
    if (!bin.empty() && !out.contains("buffers")) {
      out["buffers"] = {{{"byteLength", bin.size()}, {"uri", "data:application/octet-stream;base64," + base64(bin)}}};
    }
    return out.dump();
  }

  Bytes glb() const {
    json copy = root;
    if (!bin.empty()) copy["buffers"] = {{{"byteLength", bin.size()}}};
    std::string text = copy.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    Bytes data = bin;
    data.resize((data.size() + 3) / 4 * 4);
    Bytes out;
    append_u32(out, 0x46546C67);
    append_u32(out, 2);
    append_u32(out, static_cast<std::uint32_t>(20 + text.size() + (data.empty() ? 0 : 8 + data.size())));
    append_u32(out, static_cast<std::uint32_t>(text.size()));
    append_u32(out, 0x4E4F534A);
    out.insert(out.end(), text.begin(), text.end());
    if (!data.empty()) {
      append_u32(out, static_cast<std::uint32_t>(data.size()));
      append_u32(out, 0x004E4942);
      out.insert(out.end(), data.begin(), data.end());
    }
    return out;
  }
};

// A PNG with given dimensions and body, checksums right.
inline std::uint32_t crc32(const Bytes& bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (std::uint8_t b : bytes) {
    crc ^= b;
    for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

inline Bytes png(std::uint32_t width, std::uint32_t height, int bits, int colour_type, const Bytes& rows) {
  Bytes out{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  const auto big = [](Bytes& to, std::uint32_t v) {
    for (int i = 3; i >= 0; --i) to.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
  };
  const auto chunk = [&](const char* name, const Bytes& body) {
    big(out, static_cast<std::uint32_t>(body.size()));
    Bytes checked(name, name + 4);
    checked.insert(checked.end(), body.begin(), body.end());
    out.insert(out.end(), checked.begin(), checked.end());
    big(out, crc32(checked));
  };
  Bytes header;
  big(header, width);
  big(header, height);
  header.insert(header.end(), {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(colour_type), 0, 0, 0});
  chunk("IHDR", header);
  // zlib with stored blocks (RFC 1950, 1951): no compressor needed.
  Bytes body{0x78, 0x01};
  std::size_t at = 0;
  do {
    const std::size_t size = std::min<std::size_t>(rows.size() - at, 65535);
    const bool last = at + size == rows.size();
    const auto n = static_cast<std::uint16_t>(size);
    const auto inverse = static_cast<std::uint16_t>(~n);
    body.insert(body.end(),
                {static_cast<std::uint8_t>(last), static_cast<std::uint8_t>(n & 255), static_cast<std::uint8_t>(n >> 8),
                 static_cast<std::uint8_t>(inverse & 255), static_cast<std::uint8_t>(inverse >> 8)});
    body.insert(body.end(), rows.begin() + static_cast<std::ptrdiff_t>(at),
                rows.begin() + static_cast<std::ptrdiff_t>(at + size));
    at += size;
  } while (at < rows.size());
  std::uint32_t a = 1, b = 0;
  for (std::uint8_t v : rows) a = (a + v) % 65521, b = (b + a) % 65521;
  big(body, b << 16 | a);
  chunk("IDAT", body);
  chunk("IEND", {});
  return out;
}

// Rows for png() in one value, each behind its filter type 0.
inline Bytes plain_rows(std::size_t row_bytes, std::size_t rows, std::uint8_t value) {
  Bytes out((row_bytes + 1) * rows, value);
  for (std::size_t i = 0; i < rows; ++i) out[i * (row_bytes + 1)] = 0;
  return out;
}

// The bytes of an image file in the format of its name, 8-bit or, where the format is for light, float.
inline Bytes encode_image(const std::filesystem::path& file, int channels, const std::vector<float>& pixels, int width,
                          int height) {
  auto out = OIIO::ImageOutput::create(file.string());
  EXPECT_TRUE(out) << file;
  if (!out) return {};
  const bool is_float = file.extension() == ".exr" || file.extension() == ".hdr";
  const OIIO::ImageSpec spec(width, height, channels, is_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
  EXPECT_TRUE(out->open(file.string(), spec) && out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
  out->close();
  std::ifstream in(file, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

// A folder of its own for each test, removed after it.
class Assets : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::temp_directory_path() / ("petrichor-" + std::string(test->test_suite_name()) + "-" +
                                                       test->name() + "-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
  }
  void TearDown() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }

  Result<Model> load_text(const std::string& text, const std::string& name = "model.gltf") {
    write_file(folder / name, text);
    return load_model(folder / name);
  }
  Result<Model> load_bytes(const Bytes& bytes, const std::string& name = "model.glb") {
    write_file(folder / name, bytes);
    return load_model(folder / name);
  }
  Result<Model> load(const Builder& b) { return load_text(b.gltf()); }

  // The model, or a failed test that shows the message.
  Model must_load(const Builder& b) {
    auto model = load(b);
    EXPECT_TRUE(model) << (model ? "" : model.error().message);
    return model ? std::move(*model) : Model{};
  }

  // The error names the file, and holds every one of the parts.
  void must_fail(const Result<Model>& model, std::initializer_list<const char*> parts,
                 const std::string& file = "model.gltf") {
    ASSERT_FALSE(model) << "loaded, yet must not";
    EXPECT_NE(model.error().message.find(file), std::string::npos) << model.error().message;
    for (const char* part : parts)
      EXPECT_NE(model.error().message.find(part), std::string::npos) << model.error().message;
    EXPECT_LT(model.error().message.size(), 1000u);
  }
  void must_fail(const Builder& b, std::initializer_list<const char*> parts) { must_fail(load(b), parts); }

  static bool warned(const Model& model, const std::string& part) {
    return std::any_of(model.warnings.begin(), model.warnings.end(),
                       [&](const std::string& w) { return w.find(part) != std::string::npos; });
  }

  std::filesystem::path folder;
};

}  // namespace petrichor::testing_gltf
