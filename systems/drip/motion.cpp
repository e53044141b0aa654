#include "systems/drip/motion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "components/transform.hpp"
#include "components/view.hpp"
#include "engine/core/random.hpp"
#include "systems/drip/drip.hpp"
#include "systems/drip/physics.hpp"
#include "systems/drip/surfaces.hpp"
#include "systems/first_of.hpp"

namespace petrichor {
namespace {

constexpr std::uint32_t salt_drop = 0x64726f70u, salt_site = 0x73697465u;

// Where it stands: as propagated, or before the first propagation from its ancestors.
glm::mat4 world_of(const Registry& registry, Entity entity) {
  if (const auto* placed = registry.find<WorldTransform>(entity)) return placed->matrix;
  glm::mat4 world(1.0f);
  for (int depth = 0; depth < 64; ++depth) {
    if (const auto* t = registry.find<Transform>(entity))
      world = glm::translate(glm::mat4(1.0f), t->position_m) * glm::mat4_cast(t->orientation) *
              glm::scale(glm::mat4(1.0f), t->scale) * world;
    const auto* parent = registry.find<Parent>(entity);
    if (!parent || !registry.alive(parent->entity)) break;
    entity = parent->entity;
  }
  return world;
}

double inflow_of(const DripSource& set, double rain_mm_per_hour) {
  return std::max(rain_mm_per_hour, 0.0) / 3.6e6 * std::max(set.catchment_depth_m, 0.0f) * set.edge_share;
}

DripFlow flow_at(const DripFlow& f, double time_s) {
  DripFlow now = f;
  const double dt = time_s - f.time_s;
  now.time_s = time_s;
  now.entered_m2 += f.inflow_m2ps * dt;
  if (f.runoff_s > 0.0) {
    // dW/dt = inflow - W / tau, towards inflow tau; the rest of what came in has drained: exact at any step.
    const double gained = (f.inflow_m2ps * f.runoff_s - f.reservoir_m2) * -std::expm1(-dt / f.runoff_s);
    now.reservoir_m2 += gained;
    now.drained_m2 += f.inflow_m2ps * dt - gained;
  } else {
    now.reservoir_m2 = 0.0;
    now.drained_m2 += f.inflow_m2ps * dt + f.reservoir_m2;
  }
  return now;
}

const DripFlow& flow_of(const DripSourceMotion& s, double time_s) {
  auto after = std::upper_bound(s.flows.begin(), s.flows.end(), time_s,
                                [](double t, const DripFlow& f) { return t < f.time_s; });
  return after == s.flows.begin() ? s.flows.front() : *(after - 1);
}

bool same_edge(const DripSource& a, const DripSource& b) {
  return a.length_m == b.length_m && a.lip_radius_mm == b.lip_radius_mm && a.site_spacing_mm == b.site_spacing_mm &&
         a.jitter == b.jitter && a.site_scatter == b.site_scatter;
}

void set_edge(DripSourceMotion& s, const DripSource& set) {
  s.set = set;
  s.drop_m3 = drop_volume_m3(set.lip_radius_mm);
  const double sites = std::max(set.length_m, 0.0f) / (1e-3 * std::max(set.site_spacing_mm, 2.0f));
  s.sites = std::clamp(static_cast<int>(std::lround(sites)), 1, 100000);
}

DripSourceMotion begin(Entity entity, const DripSource& set, double rain, double time_s, std::uint32_t life) {
  DripSourceMotion s;
  s.entity = entity;
  s.life = life;
  s.seed = random_bits(glm::uvec4(life, salt_site, 17u, 0u));
  set_edge(s, set);
  // As if it had always rained so: what drops are in the air at the first frame has been falling for a while.
  DripFlow first;
  first.time_s = time_s - drip_memory_s;
  first.inflow_m2ps = inflow_of(set, rain);
  first.runoff_s = std::max(set.runoff_s, 0.0f);
  first.reservoir_m2 = first.entered_m2 = first.inflow_m2ps * first.runoff_s;
  s.wet_at_start = first.inflow_m2ps > 0.0;
  s.flows.push_back(first);
  return s;
}

// The edge is another from now on: what hung there goes back to the reservoir, and nothing is lost.
void change_edge(DripSourceMotion& s, const DripSource& set, double time_s) {
  const DripLedger before = drip_ledger(s, time_s);
  const DripFlow now = flow_at(flow_of(s, time_s), time_s);
  s.carried_out_m3 = before.detached_m3;
  ++s.edge;
  set_edge(s, set);
  DripFlow next = now;
  next.reservoir_m2 = (before.reservoir_m3 + before.pendant_m3) / std::max(s.set.length_m, 1e-3f);
  next.entered_m2 = next.drained_m2 = 0.0;
  s.carried_in_m3 = before.entered_m3;
  s.wet_at_start = false;
  s.flows = {next};
}

template <class T, class Time>
void forget(std::vector<T>& all, double before_s, Time time_of) {
  std::size_t old = 0;
  while (old + 1 < all.size() && time_of(all[old + 1]) < before_s) ++old;
  if (old > 16) all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(old));
}

void follow(DripSourceMotion& s, const DripSource& set, double rain, const glm::mat4& matrix, double time_s) {
  if (!same_edge(s.set, set)) change_edge(s, set, time_s);
  s.set = set;
  const double inflow = inflow_of(set, rain), runoff = std::max(set.runoff_s, 0.0f);
  if (const DripFlow& last = s.flows.back(); last.inflow_m2ps != inflow || last.runoff_s != runoff) {
    DripFlow next = flow_at(last, time_s);
    next.inflow_m2ps = inflow;
    next.runoff_s = runoff;
    s.flows.push_back(next);
    forget(s.flows, time_s - drip_memory_s, [](const DripFlow& f) { return f.time_s; });
  }
  if (s.poses.empty()) {
    s.poses.push_back({time_s - drip_memory_s, 0, matrix});
  } else if (s.poses.back().matrix != matrix) {
    s.poses.push_back({time_s, s.poses.back().number + 1, matrix});
    forget(s.poses, time_s - drip_memory_s, [](const DripPose& p) { return p.from_s; });
  }
}

}  // namespace

DripWater water_at(const DripSourceMotion& s, double time_s) {
  const DripFlow& f = flow_of(s, time_s);
  const DripFlow now = flow_at(f, std::max(time_s, s.flows.front().time_s));
  return {now.entered_m2, now.reservoir_m2, now.drained_m2,
          f.runoff_s > 0.0 ? now.reservoir_m2 / f.runoff_s : f.inflow_m2ps};
}

double time_of_drained(const DripSourceMotion& s, double drained) {
  auto after = std::upper_bound(s.flows.begin(), s.flows.end(), drained,
                                [](double d, const DripFlow& f) { return d < f.drained_m2; });
  const DripFlow& f = after == s.flows.begin() ? s.flows.front() : *(after - 1);
  const double wanted = std::max(drained - f.drained_m2, 0.0),
               q0 = f.runoff_s > 0.0 ? f.reservoir_m2 / f.runoff_s : 0.0;
  if (!(f.runoff_s > 0.0)) return f.time_s + std::max(wanted - f.reservoir_m2, 0.0) / std::max(f.inflow_m2ps, 1e-30);
  if (std::abs(q0 - f.inflow_m2ps) <= 1e-12 * q0) return f.time_s + wanted / std::max(q0, 1e-30);
  // g(t) = inflow t + (q0 - inflow) tau (1 - exp(-t / tau)): monotone. Newton, kept within a bracket; what is beyond
  // the flow's end has not come yet.
  const double extra = (q0 - f.inflow_m2ps) * f.runoff_s;
  double low = 0.0, high = after == s.flows.end() ? 1e7 : after->time_s - f.time_s;
  double t = std::min(wanted / std::max(q0, 1e-30), high);
  for (int i = 0; i < 60; ++i) {
    const double e = std::exp(-t / f.runoff_s);
    const double miss = f.inflow_m2ps * t + extra * (1.0 - e) - wanted;
    (miss > 0.0 ? high : low) = t;
    const double slope = f.inflow_m2ps + extra / f.runoff_s * e;
    double next = t - miss / std::max(slope, 1e-30);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - t) < 1e-9) return f.time_s + next;
    t = next;
  }
  return f.time_s + t;
}

DripSite drip_site(const DripSourceMotion& s, int site) {
  const auto bits = [&](int i) {
    return random_float4(glm::uvec4(s.seed, static_cast<std::uint32_t>(i % s.sites), salt_site, 1u));
  };
  const glm::vec4 r = bits(site);
  // Shares differ by up to a half either way, and telescope: their sum is exact.
  const double share = s.sites > 1 ? 1.0 + 0.5 * (double(r.x) - double(bits(site + 1).x)) : 1.0;
  const double scatter = std::clamp(s.set.site_scatter, 0.0f, 1.0f);
  const double along = (site + 0.5 + scatter * (double(r.y) - 0.5)) * s.set.length_m / s.sites;
  const double most = 1.0 - 0.5 * std::clamp(s.set.jitter, 0.0f, 0.9f);  // below the first threshold
  return {along, share, s.wet_at_start ? most * 0.999 * double(r.z) : 0.0};
}

double site_water_m3(const DripSourceMotion& s, const DripSite& site, double drained_m2) {
  return site.phase * s.drop_m3 + site.share * drained_m2 * (double(s.set.length_m) / s.sites);
}

double drip_threshold_m3(const DripSourceMotion& s, int site, std::int64_t k) {
  if (k < 0) return 0.0;
  const auto low = static_cast<std::uint32_t>(k), high = static_cast<std::uint32_t>(k >> 32);
  const float r = random_float(glm::uvec4(s.seed, static_cast<std::uint32_t>(site), low, salt_drop + high));
  return s.drop_m3 * (static_cast<double>(k) + 1.0 + std::clamp(double(s.set.jitter), 0.0, 0.9) * (double(r) - 0.5));
}

std::int64_t drops_fallen(const DripSourceMotion& s, int site, double water_m3) {
  // Thresholds lie within 0.45 of whole numbers of drops.
  const auto near = static_cast<std::int64_t>(std::floor(water_m3 / s.drop_m3 + 0.5));
  if (near <= 0) return 0;
  return near - 1 + (drip_threshold_m3(s, site, near - 1) <= water_m3 ? 1 : 0);
}

DripLedger drip_ledger(const DripSourceMotion& s, double time_s) {
  const DripWater w = water_at(s, time_s);
  const double length = s.set.length_m;
  DripLedger ledger;
  ledger.reservoir_m3 = w.reservoir_m2 * length;
  ledger.entered_m3 = s.carried_in_m3 + w.entered_m2 * length;
  ledger.detached_m3 = s.carried_out_m3;
  for (int i = 0; i < s.sites; ++i) {
    const DripSite site = drip_site(s, i);
    const double water = site_water_m3(s, site, w.drained_m2);
    const std::int64_t fallen = drops_fallen(s, i, water);
    const double gone = drip_threshold_m3(s, i, fallen - 1);
    ledger.entered_m3 += site.phase * s.drop_m3;
    ledger.pendant_m3 += water - gone;
    ledger.detached_m3 += gone;
    ledger.drops += static_cast<double>(fallen);
  }
  return ledger;
}

const DripPose& pose_at(const DripSourceMotion& s, double time_s) {
  auto after = std::upper_bound(s.poses.begin(), s.poses.end(), time_s,
                                [](double t, const DripPose& p) { return t < p.from_s; });
  return after == s.poses.begin() ? s.poses.front() : *(after - 1);
}

glm::dvec3 drip_wind(const DripMotion& m, double time_s) {
  if (m.winds.empty()) return glm::dvec3(0.0);
  auto after = std::upper_bound(m.winds.begin(), m.winds.end(), time_s,
                                [](double t, const WindMotion& w) { return t < w.anchor_s; });
  const WindMotion& w = after == m.winds.begin() ? m.winds.front() : *(after - 1);
  return wind_velocity(w, std::max(time_s, w.anchor_s));
}

const DripMotion* find_drip_motion(const Registry& registry) {
  const auto emitter = first_of<Emitter>(registry);
  return emitter ? registry.find<DripMotion>(emitter.entity) : nullptr;
}

void simulate_drips(Registry& registry, const std::vector<std::shared_ptr<const Model>>& models, double time_s,
                    double) {
  const auto emitter = first_of<Emitter>(registry);
  if (!emitter) return;
  const double rain = emitter->rain_mm_per_hour;
  const Entity host = emitter.entity;
  DripMotion* motion = registry.find<DripMotion>(host);
  if (!motion) {
    if (registry.size<DripSource>() == 0) return;
    motion = &registry.emplace<DripMotion>(host);
  }
  std::erase_if(motion->sources,
                [&](const DripSourceMotion& s) { return registry.find<DripSource>(s.entity) == nullptr; });
  // In the order in which they came into the world, which is theirs in storage until one is removed.
  std::vector<Entity> fresh;
  if (registry.size<DripSource>() != motion->sources.size()) {
    registry.view<const DripSource>().each([&](Entity e, const DripSource&) {
      for (const DripSourceMotion& s : motion->sources)
        if (s.entity == e) return;
      fresh.push_back(e);
    });
    std::sort(fresh.begin(), fresh.end(), [](Entity a, Entity b) { return entity_index(a) < entity_index(b); });
    for (const Entity e : fresh)
      motion->sources.push_back(begin(e, registry.get<DripSource>(e), rain, time_s, motion->lives++));
  }
  if (motion->sources.empty()) return;
  for (DripSourceMotion& s : motion->sources)
    follow(s, registry.get<DripSource>(s.entity), rain, world_of(registry, s.entity), time_s);

  const auto found = first_of<Wind>(registry);
  const Wind wind = found ? *found : Wind{};
  if (motion->winds.empty()) {
    motion->winds.push_back(start_wind_motion(wind, {}));
    follow_wind(motion->winds.back(), wind, time_s);
  } else {
    WindMotion next = motion->winds.back();
    follow_wind(next, wind, time_s);
    if (next.anchor_s != motion->winds.back().anchor_s) {
      motion->winds.push_back(std::move(next));
      forget(motion->winds, time_s - drip_memory_s, [](const WindMotion& w) { return w.anchor_s; });
    }
  }

  // Once for the scene as it stands; where models come later, again.
  if (const std::size_t instances = registry.size<MeshInstance>();
      !motion->surfaces || motion->surface_instances != instances) {
    std::vector<DripObstacle> obstacles;
    registry.view<const MeshInstance>().each([&](Entity e, const MeshInstance& mesh) {
      if (mesh.model < models.size() && mesh.mesh < models[mesh.model]->meshes.size())
        obstacles.push_back({&models[mesh.model]->meshes[mesh.mesh], world_of(registry, e)});
    });
    motion->surfaces = std::make_shared<DripSurfaces>(obstacles);
    motion->surface_instances = instances;
  }
}

}  // namespace petrichor
