#pragma once
// Inside the assets box: encoded image bytes to pixels, all through OpenImageIO.

#include <cstdint>
#include <span>
#include <string>

#include "engine/assets/model.hpp"

namespace petrichor {

inline constexpr int maximum_image_side = 16384;

// PNG, JPEG, WebP, BMP, TIFF, Radiance HDR or OpenEXR, told by its first bytes. Grey becomes RGB, a missing
// alpha opaque, 16-bit 8-bit, anything float stays float. Values stay encoded as they are (sRGB is not
// undone), alpha stays unassociated. Sizes are checked before pixels are allocated. Errors do not repeat the name.
Result<Image> decode_image(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace petrichor
