#pragma once
// What every fresh OpenGL context needs, whoever made it. Private to engine/platform.

#include <string>

#include "engine/platform/context.hpp"

namespace petrichor {

// True where the OpenGL and (with need_egl) EGL client libraries can be opened. libepoxy aborts the program
// where they are missing, so ask before the first gl* or egl* call. The message names library and package.
bool gl_libraries_present(bool need_egl, std::string& message);

// Debug messages into gl_error_count() and the log, and the fixed state that the engine counts on
// (seamless cube maps, tightly packed pixels). The context must be current.
void set_up_current_context(bool debug);

DeviceInfo describe_current_device();

// 45 for OpenGL 4.5; 0 where no context is current.
int current_gl_version();

}  // namespace petrichor
