#include "systems/drops/sums.hpp"

#include <string_view>

#include "systems/drops/rain_shared.h"

namespace petrichor {

void bind_rain_sums(RainSums& sums, int width, int height) {
  if (sums.width != width || sums.height != height) {
    sums.software = is_software_gl();
    sums.width = width;
    sums.height = height;
    // Two rows share a word of optical depth; radiance has four words a pixel.
    sums.optical_depth = make_buffer(std::size_t(width) * ((height + 1) / 2) * 4);
    sums.radiance = make_buffer(std::size_t(width) * height * 16);
    clear_buffer(sums.optical_depth);
    clear_buffer(sums.radiance);
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RAIN_OPTICAL_DEPTH_BINDING, sums.optical_depth.id);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RAIN_RADIANCE_BINDING, sums.radiance.id);
}

bool is_software_gl() {
  const char* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string_view renderer = name ? name : "";
  return renderer.find("llvmpipe") != renderer.npos || renderer.find("softpipe") != renderer.npos ||
         renderer.find("SwiftShader") != renderer.npos;
}

}  // namespace petrichor
