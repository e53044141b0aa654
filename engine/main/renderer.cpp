#include "engine/main/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/paths.hpp"
#include "engine/script/script.hpp"
#include "systems/systems.hpp"

namespace petrichor {

Result<std::unique_ptr<Renderer>> open_renderer(bool window, const ContextOptions& options) {
  auto context = window ? make_window_context(options) : make_headless_context(options);
  if (!context) return tl::unexpected(context.error());
  auto renderer = std::make_unique<Renderer>();
  renderer->context = std::move(*context);
  renderer->device = renderer->context->device();
  renderer->scene = std::make_unique<GpuScene>();
  renderer->frame_gpu = std::make_unique<FrameGpu>();
  renderer->graph = std::make_unique<Graph>(renderer->shaders, all_passes());
  renderer->timer = std::make_unique<FrameTimer>(renderer->device.software);
  return renderer;
}

Result<void> load_render_script(Renderer& renderer, const std::filesystem::path& script) {
  const auto file = find_data(script);
  if (!file) return tl::unexpected(file.error());
  ScriptOptions options;
  for (const auto& root : data_roots())
    if (std::error_code ignored; std::filesystem::is_directory(root / "scripts", ignored))
      options.roots.push_back(root / "scripts");
  std::vector<std::filesystem::path> files;
  const auto table = read_table(*file, options, &files);
  renderer.script_files = files;  // also after a failure: mending any of them is tried again
  renderer.render_script = script;
  if (!table) return tl::unexpected(table.error());
  return renderer.graph->load_table(*table, file->string());
}

Result<const Texture*> draw(Renderer& renderer, Frame& frame, bool profile) {
  finish_frame(frame);
  renderer.timer->begin_frame(profile);
  renderer.frame_gpu->upload(frame);
  auto picture = renderer.graph->execute(frame, frame.width, frame.height, *renderer.timer);
  renderer.timer->end_frame();
  return picture;
}

Size drawn_size(const Techniques& techniques, int width, int height) {
  constexpr std::array<double, 3> side{0.5, 2.0 / 3.0, 1.0};
  static_assert(side.size() == static_cast<std::size_t>(ResolutionRung::count));
  const double share = side[std::min<std::size_t>(techniques[Effect::resolution].rung, side.size() - 1)];
  const auto scaled = [&](int pixels) { return std::max(static_cast<int>(std::lround(pixels * share)), 1); };
  return {scaled(width), scaled(height)};
}

const Texture& enlarged(Renderer& renderer, const Texture& texture, int width, int height) {
  if (texture.width == width && texture.height == height) return texture;
  Texture& large = renderer.enlarged;
  if (!large.id || large.width != width || large.height != height || large.format != texture.format)
    large = make_texture_2d(width, height, texture.format);
  const Framebuffer from = make_framebuffer(std::array{static_cast<GLuint>(texture.id)}, 0);
  const Framebuffer to = make_framebuffer(std::array{static_cast<GLuint>(large.id)}, 0);
  glBlitNamedFramebuffer(from, to, 0, 0, texture.width, texture.height, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                         GL_LINEAR);
  return large;
}

std::int32_t affordable_drops(const DeviceInfo& device) {
  return device.software ? 35'000 : 10'000'000;
}

void read_picture(const Texture& texture, std::vector<std::uint8_t>& rgba8) {
  rgba8.resize(static_cast<std::size_t>(texture.width) * texture.height * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(texture.id, 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(rgba8.size()), rgba8.data());
}

void read_picture(const Texture& texture, std::vector<float>& rgba32f) {
  rgba32f.resize(static_cast<std::size_t>(texture.width) * texture.height * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(texture.id, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(rgba32f.size() * sizeof(float)),
                    rgba32f.data());
}

}  // namespace petrichor
