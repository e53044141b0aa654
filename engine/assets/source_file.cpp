#include "engine/assets/source_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace petrichor {
namespace {

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// A stray '%' stands for itself, as exporters that forget to encode mean it.
std::string percent_decode(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hex_value(text[i + 1]) >= 0 && hex_value(text[i + 2]) >= 0) {
      out.push_back(static_cast<char>(hex_value(text[i + 1]) * 16 + hex_value(text[i + 2])));
      i += 2;
    } else {
      out.push_back(text[i]);
    }
  }
  return out;
}

constexpr std::array<std::int8_t, 256> base64_values() {
  std::array<std::int8_t, 256> values{};
  for (auto& v : values) v = -1;
  for (int i = 0; i < 26; ++i) {
    values[static_cast<std::size_t>('A' + i)] = static_cast<std::int8_t>(i);
    values[static_cast<std::size_t>('a' + i)] = static_cast<std::int8_t>(26 + i);
  }
  for (int i = 0; i < 10; ++i) values[static_cast<std::size_t>('0' + i)] = static_cast<std::int8_t>(52 + i);
  values['+'] = values['-'] = 62;  // '-' and '_': the URL-safe alphabet of RFC 4648
  values['/'] = values['_'] = 63;
  return values;
}

Result<Bytes> decode_base64(std::string_view text) {
  static constexpr auto values = base64_values();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  Bytes out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int value = values[static_cast<unsigned char>(text[i])];
    if (value < 0) return failure(fmt::format("the base64 text has a character that is none at position {}", i));
    bits = (bits << 6) | static_cast<std::uint32_t>(value);
    bit_count += 6;
    if (bit_count >= 8) {
      bit_count -= 8;
      out.push_back(static_cast<std::uint8_t>((bits >> bit_count) & 0xff));
    }
  }
  return out;
}

struct Descriptor {
  int value = -1;
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
};

}  // namespace

Result<Bytes> read_regular_file(const std::filesystem::path& file) {
  // O_NONBLOCK: opening a FIFO must not wait for a writer. fstat on what was opened leaves no race.
  const Descriptor descriptor{::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  if (descriptor.value < 0) return failure(fmt::format("{}: {}", file.string(), std::strerror(errno)));
  struct stat status {};
  if (::fstat(descriptor.value, &status) != 0)
    return failure(fmt::format("{}: {}", file.string(), std::strerror(errno)));
  if (S_ISDIR(status.st_mode)) return failure(fmt::format("{}: is a folder, a file is needed", file.string()));
  if (!S_ISREG(status.st_mode)) return failure(fmt::format("{}: is no regular file", file.string()));
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size == 0) return failure(fmt::format("{}: is empty", file.string()));
  if (size > maximum_file_bytes) {
    return failure(fmt::format("{}: has {} bytes, at most {} are read", file.string(), size, maximum_file_bytes));
  }
  Bytes bytes(size);
  std::uint64_t done = 0;
  while (done < size) {
    const ssize_t got = ::read(descriptor.value, bytes.data() + done, size - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return failure(fmt::format("{}: {}", file.string(), std::strerror(errno)));
    if (got == 0) break;
    done += static_cast<std::uint64_t>(got);
  }
  bytes.resize(done);
  if (bytes.empty()) return failure(fmt::format("{}: is empty", file.string()));
  return bytes;
}

bool is_data_uri(std::string_view uri) {
  constexpr std::string_view scheme = "data:";
  if (uri.size() < scheme.size()) return false;
  for (std::size_t i = 0; i < scheme.size(); ++i) {
    const char c = uri[i] >= 'A' && uri[i] <= 'Z' ? static_cast<char>(uri[i] - 'A' + 'a') : uri[i];
    if (c != scheme[i]) return false;
  }
  return true;
}

Result<Bytes> decode_data_uri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (!is_data_uri(uri) || comma == std::string_view::npos) return failure("the data URI has no comma before its data");
  const std::string_view header = uri.substr(0, comma);
  const std::string_view payload = uri.substr(comma + 1);
  constexpr std::string_view base64 = ";base64";
  if (header.size() >= base64.size() && header.substr(header.size() - base64.size()) == base64) {
    if (payload.find('%') != std::string_view::npos) return decode_base64(percent_decode(payload));
    return decode_base64(payload);
  }
  const std::string text = percent_decode(payload);
  return Bytes(text.begin(), text.end());
}

Result<std::filesystem::path> resolve_uri(const std::filesystem::path& folder, std::string_view uri) {
  const std::string shown(uri.substr(0, 200));
  const std::size_t colon = uri.find(':');
  if (colon != std::string_view::npos && uri.find('/') > colon) {
    return failure(fmt::format("\"{}\": only data: URIs and relative paths are read", shown));
  }
  const auto inside = [&](const std::string& text) -> Result<std::filesystem::path> {
    if (text.empty()) return failure("the URI is empty");
    if (text.find('\0') != std::string::npos) return failure(fmt::format("\"{}\": holds a zero byte", shown));
    const std::filesystem::path relative = std::filesystem::path(text).lexically_normal();
    if (relative.is_absolute() || relative.begin()->string() == ".." || text[0] == '\\') {
      return failure(fmt::format("\"{}\": leads out of the model's folder, which is refused", shown));
    }
    return folder / relative;
  };
  auto decoded = inside(percent_decode(uri));
  std::error_code error;
  if (decoded && std::filesystem::exists(*decoded, error)) return decoded;
  // Not what the specification says, yet met: names that hold "%20" themselves, and Windows separators.
  std::string slashed = percent_decode(uri);
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  for (const std::string& text : {std::string(uri), slashed}) {
    auto other = inside(text);
    if (other && std::filesystem::exists(*other, error)) return other;
  }
  return decoded;
}

}  // namespace petrichor
