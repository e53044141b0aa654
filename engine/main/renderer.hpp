#pragma once
// The GPU side of a running program: context, shaders, the scene's meshes and the graph of the frame.

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/graph/graph.hpp"
#include "engine/platform/context.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"

namespace petrichor {

struct Renderer {
  std::unique_ptr<Context> context;
  DeviceInfo device;
  ShaderLibrary shaders;
  std::unique_ptr<GpuScene> scene;
  std::unique_ptr<FrameGpu> frame_gpu;
  std::unique_ptr<Graph> graph;
  std::unique_ptr<FrameTimer> timer;
  Texture enlarged;  // of enlarged()
  std::filesystem::path render_script;              // of the table the graph holds
  std::vector<std::filesystem::path> script_files;  // it was read from these
};

Result<std::unique_ptr<Renderer>> open_renderer(bool window, const ContextOptions&);

// Reads the render script's table into the graph; on failure the graph keeps what it had.
Result<void> load_render_script(Renderer&, const std::filesystem::path& script);

// Draws the frame; the texture is the finished picture (sRGB-encoded RGBA8), valid until the next call.
Result<const Texture*> draw(Renderer&, Frame&, bool profile);

// Pixels that are drawn for a picture of that size: fewer where `resolution` says so.
struct Size {
  int width, height;
};
Size drawn_size(const Techniques&, int width, int height);
// A texture at least as large as asked: the given one, or it enlarged (linearly). Valid until the next call.
const Texture& enlarged(Renderer&, const Texture&, int width, int height);

// How many drops the device draws in a share of a frame that leaves room for the city: measured figures are in
// docs/performance.md.
std::int32_t affordable_drops(const DeviceInfo&);

// Rows from the bottom, RGBA.
void read_picture(const Texture&, std::vector<std::uint8_t>& rgba8);
void read_picture(const Texture&, std::vector<float>& rgba32f);

}  // namespace petrichor
