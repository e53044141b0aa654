#pragma once
// The frame as passes. Systems offer passes (PassOffer); a render script's table says which run, in what
// order, and which resource goes in which slot; compile() culls what nobody reads or nothing asks for,
// gives transient textures out and hands them to execute().

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "engine/gpu/timer.hpp"

namespace petrichor {

struct Frame;  // systems/frame.hpp: what the passes draw; the graph only hands it on

enum class SlotAccess { read, write, modify };  // modify: reads what was there and adds to it

struct Slot {
  std::string name;         // "depth"
  SlotAccess access;
  bool optional = false;    // a read slot that may stay unconnected, or whose writers may all be culled
};

struct PassContext;

struct PassOffer {
  std::string name;                                  // "rain_field"
  std::string meaning;                               // one line for docs and `info`
  std::vector<Slot> slots;
  std::unordered_map<std::string, double> parameters;  // name -> default; the script may override
  std::unordered_map<std::string, ShaderKey> shaders;  // loaded before the first execution
  std::function<bool(const Frame&)> wanted;          // empty: always. False: nothing in the scene asks for it
  std::function<void(PassContext&)> execute;
  bool side_effect = false;  // runs also where nobody reads what it writes. So does a pass without write or modify slots.
  std::function<Result<void>(const Program&)> check;  // after the shaders are loaded; empty: nothing to check
};

struct PassContext {
  const Frame& frame;
  int width;   // of the output image, pixels
  int height;

  // The texture in a slot. Asserts on names that the offer did not declare.
  const Texture& texture(std::string_view slot) const;
  bool has(std::string_view slot) const;  // false: unconnected, or nobody wrote it this frame
  // Of a persistent resource: true from when its texture was made (load, reload, reset, new size) until the
  // first pass that writes it has run. Its content is then undefined and must be drawn. Others: always true.
  bool fresh(std::string_view slot) const;
  const Program& program(std::string_view name) const;
  float parameter(std::string_view name) const;

  void bind_texture(int unit, std::string_view slot) const;                      // glBindTextureUnit
  void bind_image(int unit, std::string_view slot, GLenum access, int level = 0) const;  // glBindImageTexture
  // A framebuffer over the named slots' textures, cached; depth "" for none. Bound, viewport set.
  void bind_framebuffer(std::span<const std::string_view> colour_slots, std::string_view depth_slot) const;

  struct Impl;
  Impl* impl;
};

struct PassReport {
  std::string name;
  bool culled;
  std::string reason;  // why it was culled: "nobody reads bloom", "no component asks for it"
};

// Resources a script may declare without describing them.
//   table.resources.NAME = { format = "rgba16f", scale = 1.0 | width/height, history = true, mips = n,
//                            persistent = true }
// persistent: the texture is its own (never aliased) and keeps its content between frames, so that a pass may
// decide to leave it as it is (cached shadow and occlusion maps). It can stand beside a fixed width/height.
// A read of "previous:NAME" is last frame's content of a history resource (cleared on the first frame).
// Script passes: { pass = "name", SLOT = "resource", ..., parameters = {...} }, or an artist's own compute
// shader: { compute = "file.comp.glsl", name = "...", read = { SAMPLER = "resource" },
//           write = { IMAGE = "resource" }, parameters = { uniform = value } }. A wrong table is an error with its path.
class Graph {
 public:
  Graph(ShaderLibrary&, std::vector<PassOffer> offers);
  ~Graph();

  // Reads a render table (see docs/reference.md). On failure the graph keeps what it had before.
  Result<void> load_table(const nlohmann::json& table, std::string_view source);
  // Runs the passes that the frame asks for; returns the texture the table names as output. Valid until the
  // next execute. A failure (shader, missing writer) names pass and resource.
  Result<const Texture*> execute(const Frame&, int width, int height, FrameTimer&);
  // The texture that the table's optional `linear_output` names (scene-linear light before the tone map), kept
  // whole to the end of the frame; null where the table names none. Valid as long as execute's result.
  const Texture* linear_output() const;
  // Forget history and transient textures (a cut, a new scene).
  void reset();

  std::vector<PassReport> report() const;  // as of the last execute
  std::string dot() const;                 // Graphviz, culled passes dimmed
  std::span<const PassOffer> offers() const;
  std::vector<std::string> files() const;  // artist shaders, for the reload watch

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace petrichor
