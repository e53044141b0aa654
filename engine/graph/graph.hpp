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
  std::string name;  // "depth"
  SlotAccess access;
  // May stay unconnected. Ask has(): an optional read is empty where its writers are all culled, an optional write or
  // modify where nobody reads what it would add.
  bool optional = false;
};

struct PassContext;

struct PassOffer {
  std::string name;     // "rain_field"
  std::string meaning;  // one line for docs and `info`
  std::vector<Slot> slots;
  std::unordered_map<std::string, double> parameters;  // name -> default; the script may override
  std::unordered_map<std::string, ShaderKey> shaders;  // loaded before the first execution
  std::function<bool(const Frame&)> wanted;            // empty: always. False: nothing in the scene asks for it
  std::function<void(PassContext&)> execute;
  // Runs also where nobody reads what it writes. So does a pass without write or modify slots.
  bool side_effect = false;
  // Looks at each shader once it is loaded; an error fails the table. Empty: nothing to check.
  std::function<Result<void>(const Program&)> check;
};

struct PassContext {
  const Frame& frame;
  int width;  // of the output image, pixels
  int height;

  // The texture in a slot. Asserts on names that the offer did not declare.
  const Texture& texture(std::string_view slot) const;
  bool has(std::string_view slot) const;  // false: unconnected, or nobody wrote it this frame
  // Of a persistent resource: true from when its texture was made (load, reload, reset, new size) until the
  // first pass that writes it has run. Its content is then undefined and must be drawn. Others: always true.
  bool fresh(std::string_view slot) const;
  const Program& program(std::string_view name) const;
  float parameter(std::string_view name) const;

  void bind_texture(int unit, std::string_view slot) const;                              // glBindTextureUnit
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

// The render table, as the script returns it:
//
//   return {
//     resources = { NAME = { format = "rgba16f", ... }, ... },
//     passes = { { "gbuffer", depth = "depth", ... }, ... },     -- in order of execution
//     output = "picture",                                        -- the resource to show
//     linear_output = "light",                                   -- optional: scene-linear light, for EXR
//   }
//
// A resource: format (engine/gpu/formats.cpp lists them; "none": no texture, it stands for buffers that passes share
// among themselves, so that these too are ordered and culled), and
//   scale = 1.0               of the output size, rounded up; or width and height in pixels
//   mips = 1                  levels; 0: down to one pixel
//   layers = n                a 2D array
//   clear = {r, g, b, a}      what it holds until a pass writes it, every frame; one number means all four.
//                             Without it the content of a fresh texture is undefined: write every pixel.
//   history = true            "previous:NAME" reads last frame's content; cleared on the first frame, after a frame in
//                             which nothing wrote it, after a reload, and when the size changes
//   persistent = true         the texture is its own and keeps its content between frames (cached maps, sums); a pass
//                             may then leave it as it is, and reading or modifying before this frame's write is fine
//
// A pass: { "name" or pass = "name", SLOT = "resource", ..., parameters = { name = number }, id = "...",
// enabled = true }. id is needed where one pass stands twice; timings and reports use it.
// An artist's own: { compute = "file.comp.glsl", name = "...", read = { SAMPLER = "resource" },
// write = { IMAGE = "resource" }, modify = { IMAGE = "resource" }, parameters = { UNIFORM = number or list } }; one
// invocation a pixel of the largest image, `uniform ivec2 u_size` is its size.
//
// write begins a new version of a resource and modify goes on with the version before, so a pass may read and write one
// name. A pass that is not wanted is as if it were not in the table: a modify passes on what it found, an optional read
// finds has() false, a required read of what nobody wrote culls the reader too. Of the rest run the passes that the
// output needs, and those with effects of their own. A wrong table is an error with its place in it.
//
// Each pass starts from the same GL state: no blending, culling, depth or scissor test, all masks on, the viewport of
// the output, no framebuffer and no vertex array bound. Bound buffers (the frame's uniforms at 0) stay. A full
// memory barrier follows each pass; within a pass barriers are the pass's own affair.
class Graph {
 public:
  Graph(ShaderLibrary&, std::vector<PassOffer> offers);
  ~Graph();

  // Reads a render table and loads its shaders. On failure the graph keeps what it had before.
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
  // Artist shaders, under the data roots, of the table that runs and of the last one that failed to load: when one of
  // these changes after a failure, load the table again. (Of a table that runs, ShaderLibrary reloads them.)
  std::vector<std::string> files() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace petrichor
