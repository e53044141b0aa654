#include "engine/graph/graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "engine/graph/dot.hpp"
#include "engine/graph/plan.hpp"
#include "engine/graph/table.hpp"

namespace petrichor {
namespace {

Texture make_texture(const TextureKey& key) {
  if (key.format == GL_NONE) return {};
  return key.layers ? make_texture_2d_array(key.width, key.height, key.layers, key.format, key.levels)
                    : make_texture_2d(key.width, key.height, key.format, key.levels);
}

struct History {
  std::array<Texture, 2> textures;
  int now = 0;           // index written this frame
  bool written = false;  // this frame
};

struct Persistent {
  Texture texture;
  bool fresh = true;
};

// A pass left out must not change how the next one draws: all start from the same state.
void reset_gl_state() {
  for (const GLenum capability : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_DEPTH_CLAMP, GL_SCISSOR_TEST,
                                  GL_STENCIL_TEST, GL_POLYGON_OFFSET_FILL, GL_FRAMEBUFFER_SRGB}) {
    glDisable(capability);
  }
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glBindVertexArray(0);
}

std::vector<std::string> artist_files(const Table& table) {
  std::vector<std::string> files;
  for (const PassNode& pass : table.passes) {
    if (!pass.own_offer) continue;
    for (const auto& [name, key] : pass.own_offer->shaders)
      files.insert(files.end(), key.files.begin(), key.files.end());
  }
  return files;
}

// What load_table makes and swaps in as a whole, so that a failure leaves the old one standing.
struct Compiled {
  Table table;
  std::vector<std::map<std::string, const Program*, std::less<>>> programs;  // of each pass
};

}  // namespace

struct Graph::Impl {
  explicit Impl(ShaderLibrary& library, std::vector<PassOffer> list) : shaders(library), offers(std::move(list)) {}

  ShaderLibrary& shaders;
  std::vector<PassOffer> offers;
  std::optional<Compiled> compiled;
  std::vector<std::string> failed_files;  // artist shaders of the last table, where it failed to load

  // The current plan and what it was made for.
  std::optional<Plan> plan;
  std::vector<bool> wanted;
  int width = 0, height = 0;

  std::vector<Texture> pool;         // one a physical of the plan
  std::map<int, History> histories;  // by resource
  std::map<int, Persistent> persistents;
  std::map<std::vector<GLuint>, Framebuffer> framebuffers;  // colour ids, then the depth id

  void drop_textures() {
    framebuffers.clear();
    pool.clear();
    histories.clear();
    persistents.clear();
    plan.reset();
  }

  void make_ready(std::vector<bool> now_wanted, int w, int h) {
    if (plan && wanted == now_wanted && width == w && height == h) return;
    const Table& table = compiled->table;
    wanted = std::move(now_wanted);
    width = w;
    height = h;
    plan = make_plan(table, wanted, w, h);

    // Keep the textures that fit, give the rest back. Framebuffers may hold ids that are about to be reused.
    framebuffers.clear();
    std::vector<Texture> old = std::exchange(pool, {});
    for (const TextureKey& key : plan->physicals) {
      const auto fits = std::find_if(old.begin(), old.end(), [&](const Texture& t) {
        const int layers = t.target == GL_TEXTURE_2D_ARRAY ? t.layers : 0;
        return t.id && TextureKey{t.width, t.height, t.levels, layers, t.format} == key;
      });
      pool.push_back(fits != old.end() ? std::move(*fits) : make_texture(key));
    }
    for (const Storage& storage : plan->storages) {
      if (storage.first_pass < 0) continue;
      const ResourceDesc& desc = table.resources[storage.resource];
      const TextureKey key = texture_key(desc, w, h);
      const auto same_size = [&](const Texture& t) { return t.id && t.width == key.width && t.height == key.height; };
      if (storage.kind == StorageKind::history_now || storage.kind == StorageKind::history_previous) {
        History& history = histories[storage.resource];
        for (Texture& texture : history.textures) {
          if (same_size(texture)) continue;
          texture = make_texture(key);
          clear_texture(texture, desc.clear.value_or(std::array<float, 4>{}));
        }
      } else if (storage.kind == StorageKind::persistent) {
        Persistent& persistent = persistents[storage.resource];
        if (same_size(persistent.texture)) continue;
        persistent.texture = make_texture(key);
        persistent.fresh = true;
        if (desc.clear) clear_texture(persistent.texture, *desc.clear);
      }
    }
  }

  const Texture& texture_of(const Storage& storage) {
    switch (storage.kind) {
      case StorageKind::transient:
        return pool[storage.physical];
      case StorageKind::history_now: {
        History& history = histories.at(storage.resource);
        return history.textures[history.now];
      }
      case StorageKind::history_previous: {
        History& history = histories.at(storage.resource);
        return history.textures[1 - history.now];
      }
      case StorageKind::persistent:
        break;
    }
    return persistents.at(storage.resource).texture;
  }

  // Before the frame: what was written last frame becomes previous.
  void turn_histories() {
    for (auto& [resource, history] : histories) {
      history.now = 1 - history.now;
      // A writer that rested leaves nothing behind: stale content would come back as a ghost.
      if (!std::exchange(history.written, false)) {
        clear_texture(history.textures[1 - history.now],
                      compiled->table.resources[resource].clear.value_or(std::array<float, 4>{}));
      }
    }
  }

  // An output whose writers all rest shows what the resource is cleared to.
  void clear_untouched(int storage) {
    if (storage < 0 || !plan->storages[storage].clear_first) return;
    for (const PassPlan& pass : plan->passes) {
      if (std::find(pass.slot_storage.begin(), pass.slot_storage.end(), storage) != pass.slot_storage.end()) return;
    }
    const Storage& output = plan->storages[storage];
    clear_texture(texture_of(output), *compiled->table.resources[output.resource].clear);
  }

  void run_pass(std::size_t index, const Frame& frame, FrameTimer& timer);
};

struct PassContext::Impl {
  Graph::Impl* graph;
  std::size_t pass;

  const PassNode& node() const { return graph->compiled->table.passes[pass]; }
  // Index of a slot; asserts that the offer declares it.
  std::size_t slot(std::string_view name) const {
    const std::vector<Slot>& slots = node().offer->slots;
    const auto found = std::find_if(slots.begin(), slots.end(), [&](const Slot& s) { return s.name == name; });
    assert(found != slots.end() && "a slot that the offer does not declare");
    return found == slots.end() ? 0 : static_cast<std::size_t>(found - slots.begin());
  }
  const Storage* storage(std::string_view name) const {
    const int index = graph->plan->passes[pass].slot_storage[slot(name)];
    return index < 0 ? nullptr : &graph->plan->storages[index];
  }
};

const Texture& PassContext::texture(std::string_view slot) const {
  const Storage* storage = impl->storage(slot);
  assert(storage && "an empty slot: ask has() first");
  static const Texture none;
  return storage ? impl->graph->texture_of(*storage) : none;
}

bool PassContext::has(std::string_view slot) const {
  return impl->storage(slot) != nullptr;
}

bool PassContext::fresh(std::string_view slot) const {
  const Storage* storage = impl->storage(slot);
  if (!storage || storage->kind != StorageKind::persistent) return true;
  return impl->graph->persistents.at(storage->resource).fresh;
}

const Program& PassContext::program(std::string_view name) const {
  const auto& programs = impl->graph->compiled->programs[impl->pass];
  const auto found = programs.find(name);
  assert(found != programs.end() && "a program that the offer does not declare");
  return *found->second;
}

float PassContext::parameter(std::string_view name) const {
  const auto& parameters = impl->node().parameters;
  const auto found = parameters.find(std::string(name));
  assert(found != parameters.end() && "a parameter that the offer does not declare");
  return found == parameters.end() ? 0.0f : static_cast<float>(found->second);
}

void PassContext::bind_texture(int unit, std::string_view slot) const {
  glBindTextureUnit(static_cast<GLuint>(unit), texture(slot).id);
}

void PassContext::bind_image(int unit, std::string_view slot, GLenum access, int level) const {
  const Texture& t = texture(slot);
  const GLboolean layered = t.target != GL_TEXTURE_2D;
  glBindImageTexture(static_cast<GLuint>(unit), t.id, level, layered, 0, access, t.format);
}

void PassContext::bind_framebuffer(std::span<const std::string_view> colour_slots, std::string_view depth_slot) const {
  std::vector<GLuint> ids;
  const Texture* sized = nullptr;
  for (const std::string_view slot : colour_slots) {
    sized = &texture(slot);
    ids.push_back(sized->id);
  }
  GLuint depth = 0;
  if (!depth_slot.empty()) {
    sized = &texture(depth_slot);
    depth = sized->id;
  }
  ids.push_back(depth);
  auto found = impl->graph->framebuffers.find(ids);
  if (found == impl->graph->framebuffers.end()) {
    Framebuffer made = make_framebuffer(std::span(ids).first(ids.size() - 1), depth);
    found = impl->graph->framebuffers.emplace(std::move(ids), std::move(made)).first;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, found->second);
  if (sized) glViewport(0, 0, sized->width, sized->height);
}

void Graph::Impl::run_pass(std::size_t index, const Frame& frame, FrameTimer& timer) {
  const PassNode& node = compiled->table.passes[index];
  timer.begin(node.id);
  glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, node.id.c_str());
  reset_gl_state();
  glViewport(0, 0, width, height);
  for (const int s : plan->passes[index].slot_storage) {
    if (s < 0) continue;
    const Storage& storage = plan->storages[s];
    if (storage.clear_first && storage.first_pass == static_cast<int>(index)) {
      clear_texture(texture_of(storage), *compiled->table.resources[storage.resource].clear);
    }
  }
  PassContext::Impl inner{this, index};
  PassContext context{frame, width, height, &inner};
  node.offer->execute(context);
  for (std::size_t s = 0; s < node.connections.size(); ++s) {
    const int at = plan->passes[index].slot_storage[s];
    if (at < 0 || !writes(node.offer->slots[s].access)) continue;
    const Storage& storage = plan->storages[at];
    if (storage.kind == StorageKind::persistent) persistents.at(storage.resource).fresh = false;
    if (storage.kind == StorageKind::history_now) histories.at(storage.resource).written = true;
  }
  // Image and buffer stores are invisible to what follows without it; one a pass costs next to nothing.
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  glPopDebugGroup();
  timer.end();
}

Graph::Graph(ShaderLibrary& shaders, std::vector<PassOffer> offers)
    : impl_(std::make_unique<Impl>(shaders, std::move(offers))) {
  for ([[maybe_unused]] const PassOffer& offer : impl_->offers) {
    assert(offer.execute && "a pass without execute");
    for ([[maybe_unused]] const Slot& slot : offer.slots) {
      assert(slot.name != "pass" && slot.name != "id" && slot.name != "parameters" && slot.name != "enabled" &&
             "a slot named like a key of the table");
    }
  }
}

Graph::~Graph() = default;

Result<void> Graph::load_table(const nlohmann::json& json, std::string_view source) {
  auto table = read_table(json, source, impl_->offers);
  if (!table) return tl::unexpected(table.error());
  Compiled compiled;
  compiled.table = *std::move(table);
  impl_->failed_files = artist_files(compiled.table);
  for (const PassNode& pass : compiled.table.passes) {
    auto& programs = compiled.programs.emplace_back();
    const auto fail = [&](const std::string& message) {
      return failure(fmt::format("{}: pass {}: {}", source, pass.id, message));
    };
    for (const auto& [name, key] : pass.offer->shaders) {
      auto program = impl_->shaders.load(key);
      if (!program) return fail(program.error().message);
      if (pass.offer->check) {
        if (auto fine = pass.offer->check(**program); !fine) return fail(fine.error().message);
      }
      programs[name] = *program;
    }
  }
  impl_->drop_textures();
  impl_->compiled = std::move(compiled);
  impl_->failed_files.clear();
  return {};
}

Result<const Texture*> Graph::execute(const Frame& frame, int width, int height, FrameTimer& timer) {
  if (!impl_->compiled) return failure("The frame has no passes yet: no render table was loaded.");
  if (width <= 0 || height <= 0)
    return failure(fmt::format("An image of {}x{} pixels cannot be drawn.", width, height));
  std::vector<bool> wanted;
  for (const PassNode& pass : impl_->compiled->table.passes) {
    wanted.push_back(!pass.offer->wanted || pass.offer->wanted(frame));
  }
  impl_->make_ready(std::move(wanted), width, height);
  const Plan& plan = *impl_->plan;
  if (!plan.error.empty()) return failure(plan.error);

  impl_->turn_histories();
  for (std::size_t p = 0; p < plan.passes.size(); ++p) {
    if (plan.passes[p].runs) impl_->run_pass(p, frame, timer);
  }
  reset_gl_state();
  impl_->clear_untouched(plan.output_storage);
  impl_->clear_untouched(plan.linear_output_storage);
  return &impl_->texture_of(plan.storages[plan.output_storage]);
}

const Texture* Graph::linear_output() const {
  if (!impl_->plan || impl_->plan->linear_output_storage < 0) return nullptr;
  return &impl_->texture_of(impl_->plan->storages[impl_->plan->linear_output_storage]);
}

void Graph::reset() {
  impl_->drop_textures();
}

std::vector<PassReport> Graph::report() const {
  std::vector<PassReport> reports;
  if (!impl_->compiled) return reports;
  const Table& table = impl_->compiled->table;
  for (std::size_t p = 0; p < table.passes.size(); ++p) {
    // Before the first execute nothing is known; nothing is culled either.
    const bool culled = impl_->plan && !impl_->plan->passes[p].runs;
    reports.push_back({table.passes[p].id, culled, culled ? impl_->plan->passes[p].reason : ""});
  }
  return reports;
}

std::string Graph::dot() const {
  if (!impl_->compiled) return "digraph frame {\n}\n";
  const Table& table = impl_->compiled->table;
  if (impl_->plan) return write_dot(table, *impl_->plan);
  return write_dot(table, make_plan(table, std::vector<bool>(table.passes.size(), true), 1280, 720));
}

std::span<const PassOffer> Graph::offers() const {
  return impl_->offers;
}

std::vector<std::string> Graph::files() const {
  std::vector<std::string> files = impl_->failed_files;
  if (impl_->compiled) {
    for (std::string& file : artist_files(impl_->compiled->table)) files.push_back(std::move(file));
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace petrichor
