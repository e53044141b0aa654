#include "engine/main/direction.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "components/components.hpp"
#include "engine/core/log.hpp"
#include "engine/core/paths.hpp"
#include "systems/director/figures.hpp"

namespace petrichor {
namespace {

constexpr float warm_up_rain_mm_per_hour = 5.0f, warm_up_snow_mm_per_hour = 1.0f;

bool may_be_chosen(const Ladder& ladder, const Rung& rung) {
  return ladder.directed && usable(rung);
}

bool same(const Techniques& a, const Techniques& b) {
  return std::equal(a.choices.begin(), a.choices.end(), b.choices.begin(), [](const Choice& x, const Choice& y) {
    return x.rung == y.rung && x.from == y.from && x.blend == y.blend;
  });
}

// Where it is dry it rains or snows while this lives, else the passes of rain and snow would be left out.
template <class Component>
class Pretend {
 public:
  Pretend(Registry& registry, float Component::*rate, float least) : registry_(registry), rate_(rate) {
    registry.view<Component>().each([&](Entity entity, Component& component) {
      rates_.emplace_back(entity, component.*rate);
      component.*rate = std::max(component.*rate, least);
    });
  }
  ~Pretend() {
    for (const auto& [entity, rate] : rates_) registry_.get<Component>(entity).*rate_ = rate;
  }
  Pretend(const Pretend&) = delete;
  Pretend& operator=(const Pretend&) = delete;

 private:
  Registry& registry_;
  float Component::*rate_;
  std::vector<std::pair<Entity, float>> rates_;
};

}  // namespace

Result<Direction> Direction::open(const Techniques& asked) {
  std::vector<Ladder> ladders = all_ladders();
  if (const auto file = find_data("content/ladders.csv")) {
    if (auto loaded = load_ladder_figures(*file, ladders); !loaded) return tl::unexpected(loaded.error());
  } else {
    log_warn("content/ladders.csv is not there, so the director begins with the ladders' own figures: {}",
             file.error().message);
  }
  Direction direction;
  direction.director_ = make_director(std::move(ladders), asked);
  direction.asked_ = asked;
  direction.input_.asked = asked;
  direction.output_.techniques = asked;
  return direction;
}

Result<void> Direction::warm_up(Renderer& renderer, World& world, double time_s, int width, int height) {
  const Pretend rain(world.registry(), &Emitter::rain_mm_per_hour, warm_up_rain_mm_per_hour);
  const Pretend snow(world.registry(), &Snowfall::snow_mm_per_hour, warm_up_snow_mm_per_hour);
  const Techniques before = world.techniques();
  Result<void> outcome;
  for (const Ladder& ladder : director_.costs.ladders)
    for (std::size_t r = 0; r < ladder.rungs.size() && outcome; ++r) {
      if (world.chosen_by_user(ladder.effect) || !may_be_chosen(ladder, ladder.rungs[r])) continue;
      // The whole scene at every size; the rungs of effects on a small picture: what they do is the same.
      world.techniques() = before;
      if (ladder.effect != Effect::resolution) world.techniques().set(Effect::resolution, ResolutionRung::half);
      world.techniques().set(ladder.effect, static_cast<std::uint8_t>(r));
      const Size size = drawn_size(world.techniques(), width, height);
      Frame frame;
      world.extract(frame, 0, time_s, size.width, size.height);
      if (auto drawn = draw(renderer, frame, false); !drawn) outcome = tl::unexpected(drawn.error());
      glFinish();
    }
  world.techniques() = before;
  return outcome;
}

// Drawn by its first rung, which for what lands, wets and mirrors is to leave it out.
bool Direction::left_out(World& world, const Ladder& ladder) const {
  const Choice& choice = world.techniques()[ladder.effect];
  return budget_ms > 0.0 && ladder.directed && !world.chosen_by_user(ladder.effect) && choice.rung == 0 &&
         choice.blend >= 1.0f;
}

// An effect that is left out is not in the frame, so it cannot say how much of the picture it would take: now and then a
// frame is extracted as if it were drawn, or it would stay out for ever.
void Direction::ask_of_what_is_left_out(World& world, const std::function<void()>& extract_it, const Frame& frame) {
  constexpr int asked_every = 15;  // frames
  if (frames_++ % asked_every != 0) return;
  const Techniques now = world.techniques();
  std::vector<const Ladder*> asked;
  for (const Ladder& ladder : director_.costs.ladders)
    if (ladder.rungs.size() > 1 && left_out(world, ladder)) asked.push_back(&ladder);
  if (asked.empty()) return;
  for (const Ladder* ladder : asked) world.techniques().set(ladder->effect, std::uint8_t{1});
  extract_it();
  for (const Ladder* ladder : asked)
    coverage_left_out_[static_cast<std::size_t>(ladder->effect)] = std::clamp(ladder->coverage(frame), 0.0, 1.0);
  world.techniques() = now;
}

void Direction::extract(World& world, Frame& frame, std::uint64_t number, double time_s, double step_s, int width,
                        int height) {
  const auto extract_it = [&] {
    const Size size = drawn_size(world.techniques(), width, height);
    world.extract(frame, number, time_s, size.width, size.height);
  };
  ask_of_what_is_left_out(world, extract_it, frame);
  extract_it();
  for (const Ladder& ladder : director_.costs.ladders) {
    const auto e = static_cast<std::size_t>(ladder.effect);
    input_.coverage[e] = left_out(world, ladder) ? coverage_left_out_[e] : std::clamp(ladder.coverage(frame), 0.0, 1.0);
  }
  input_.budget_ms = budget_ms;
  input_.step_s = step_s;
  for (std::size_t e = 0; e < effect_count; ++e) input_.pinned[e] = world.chosen_by_user(static_cast<Effect>(e));
  output_ = direct(director_, input_);
  if (!same(world.techniques(), output_.techniques)) {
    world.techniques() = output_.techniques;
    extract_it();
  }
  input_.frame_ms = 0.0;  // known once
  input_.passes = {};
}

void Direction::measured(double frame_ms, std::span<const Timing> passes, bool gpu_times) {
  passes_.clear();
  for (const Timing& pass : passes) passes_.push_back({pass.name, pass.milliseconds});
  input_.frame_ms = frame_ms;
  input_.profiled = output_.profile_next;
  input_.gpu_times = gpu_times;
  input_.passes = passes_;
}

nlohmann::json Direction::report() const {
  nlohmann::json all = nlohmann::json::array();
  for (const DirectorNote& note : notes())
    all.push_back({{"effect", note.effect},
                   {"rung", note.rung},
                   {"ms", note.ms},
                   {"error", note.error},
                   {"coverage", note.coverage},
                   {"switches", note.switches},
                   {"why", note.why}});
  return all;
}

nlohmann::json Direction::changes() const {
  nlohmann::json all = nlohmann::json::array();
  for (const DirectorSwitch& change : director_.history) {
    const Ladder& ladder = director_.costs.ladders[static_cast<std::size_t>(change.effect)];
    all.push_back({{"frame", change.frame},
                   {"time_s", change.time_s},
                   {"effect", ladder.name},
                   {"from", ladder.rungs[static_cast<std::size_t>(change.from)].name},
                   {"to", ladder.rungs[static_cast<std::size_t>(change.to)].name},
                   {"frame_ms", change.level_ms},
                   {"expected_ms", change.expected_ms},
                   {"reason", change.reason}});
  }
  return all;
}

}  // namespace petrichor
