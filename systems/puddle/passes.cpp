#include <cstring>
#include <memory>

#include "systems/puddle/list.hpp"
#include "systems/puddle/puddle.hpp"

namespace petrichor {
namespace {

struct Buffers {
  Buffer list, cells;
  std::vector<std::byte> bytes;
};

void bind_puddles(PassContext& context, Buffers& b) {
  const PuddleList list = list_puddles(*context.frame.puddles, context.frame.camera.position_m);
  const std::size_t all = list.puddles.size() * sizeof(PuddleGpu);
  b.bytes.resize(sizeof list.head + all);
  std::memcpy(b.bytes.data(), &list.head, sizeof list.head);
  std::memcpy(b.bytes.data() + sizeof list.head, list.puddles.data(), all);
  upload(b.list, b.bytes.data(), b.bytes.size());
  upload(b.cells, std::span<const std::uint32_t>(list.cells));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PUDDLE_LIST_BINDING, b.list.id);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PUDDLE_CELLS_BINDING, b.cells.id);
}

}  // namespace

std::vector<PassOffer> puddle_passes() {
  auto buffers = std::make_shared<Buffers>();
  std::vector<PassOffer> offers;
  offers.push_back({"puddles",
                    "where water stands and how deep: the puddles in view, for wet_surfaces",
                    {{"puddle_list", SlotAccess::write}},
                    {},
                    {},
                    [](const Frame& frame) { return frame.puddles && frame.puddles->any_water; },
                    [buffers](PassContext& context) { bind_puddles(context, *buffers); }});
  return offers;
}

}  // namespace petrichor
