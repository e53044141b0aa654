#pragma once
#include <filesystem>
#include <memory>

#include "engine/app/recorder.hpp"

namespace petrichor {

// A film through the ffmpeg program: raw frames go down a pipe. Without ffmpeg the error says how to get it
// and that a numbered picture sequence works without.
Result<std::unique_ptr<Recorder>> make_film_recorder(const std::filesystem::path& file, int width, int height,
                                                     double fps);

}  // namespace petrichor
