#include "systems/drip/extract.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "engine/core/random.hpp"
#include "systems/drip/drip.hpp"
#include "systems/drip/physics.hpp"
#include "systems/drip/surfaces.hpp"
#include "systems/drops/drop_physics.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/frustum.hpp"

namespace petrichor {
namespace {

constexpr double piece_m = 1.6, bucket_m = 2.0;  // clusters: along the edge, and down
constexpr double thread_s = 0.25;                // a thread breaks up into drops after so long a fall
constexpr double fastest_site_hz = 60.0;         // of more drops a second, some are drawn as one stretched drop

struct Seen {
  FrameDrip drop;
  double distance2;
};

struct Extraction {
  const DripMotion& motion;
  const FrameCamera& camera;
  Frustum frustum;
  double time_s;
  std::vector<Seen> seen;
  FrameDrips frame;
  // Wind at whole steps of time, from the oldest on: a drop's is between two of them.
  std::int64_t first_wind = 0;
  std::vector<glm::dvec3> winds;
};

constexpr double winds_per_s = 30.0;

void know_winds(Extraction& x) {
  x.first_wind = static_cast<std::int64_t>(std::floor((x.time_s - drip_memory_s) * winds_per_s)) - 1;
  const auto last = static_cast<std::int64_t>(std::ceil(x.time_s * winds_per_s)) + 1;
  for (std::int64_t i = x.first_wind; i <= last; ++i)
    x.winds.push_back(drip_wind(x.motion, static_cast<double>(i) / winds_per_s));
}

glm::dvec3 wind_at(const Extraction& x, double time_s) {
  const double at = std::clamp(time_s * winds_per_s - static_cast<double>(x.first_wind), 0.0,
                               static_cast<double>(x.winds.size()) - 1.001);
  const auto low = static_cast<std::size_t>(at);
  return glm::mix(x.winds[low], x.winds[low + 1], at - static_cast<double>(low));
}

// What of one source does not change from site to site.
struct Edge {
  const DripSourceMotion* source;
  std::uint16_t number;  // of FrameDrips::sources
  DripWater now;
  bool in_view, near;
  bool site_in_view, site_near;     // of the site that is looked at
  const std::vector<float>* falls;  // as the wind is now; of earlier drops looked up anew
  glm::dvec3 wind;
  std::vector<std::uint16_t> clusters;  // of (piece, bucket): 1 + number, 0: none yet
  int buckets = 1;
  double in_air_m2 = 0.0;  // what had drained when the oldest drop that may be in the air let go
  // Where drops land, as looked up last.
  const std::vector<float>* last = nullptr;
  glm::ivec3 cell{0};
  std::uint32_t pose = 0;
};

struct Fallen {
  double detach_s;
  double volume_m3;
  std::int64_t k;
  double gap_s;  // since the site's drop before
};

bool inside(const Frustum& frustum, const glm::dvec3& relative, double radius) {
  return sphere_touches(frustum, glm::vec3(relative), static_cast<float>(radius));
}

std::uint16_t cluster_of(Extraction& x, Edge& e, const DripSite& site, const glm::dvec3& lip, const glm::dvec3& at) {
  const int piece = static_cast<int>(site.along_m / piece_m);
  const int bucket = std::clamp(static_cast<int>((lip.y - at.y) / bucket_m), 0, e.buckets - 1);
  std::uint16_t& number = e.clusters[static_cast<std::size_t>(piece * e.buckets + bucket)];
  if (number == 0 && x.frame.clusters.size() < 65000) {
    // About the first of its drops; wide enough for the others.
    x.frame.clusters.push_back({{at.x, lip.y - (bucket + 0.5) * bucket_m, at.z}, 2.2f});
    number = static_cast<std::uint16_t>(x.frame.clusters.size());
  }
  return static_cast<std::uint16_t>(number - 1);
}

double distance2_to_way(const glm::dvec3& eye, const glm::dvec3& lip, double fall) {
  const double y = std::clamp(eye.y, lip.y - fall, lip.y);
  const glm::dvec3 d(lip.x - eye.x, y - eye.y, lip.z - eye.z);
  return glm::dot(d, d);
}

void add_seen(Extraction& x, Edge& e, const DripSite& site, const glm::dvec3& lip, FrameDrip drop) {
  const glm::dvec3 relative = drop.place_m - x.camera.position_m;
  const double reach = glm::length(drop.velocity_mps) * x.camera.exposure_s + 1e-3 * drop.diameter_mm * drop.stretch;
  if (!inside(x.frustum, relative, reach + 0.01)) return;
  drop.source = e.number;
  drop.cluster = cluster_of(x, e, site, lip, drop.place_m);
  x.seen.push_back({drop, glm::dot(relative, relative)});
}

// The drop where it is now, or where it landed.
void add_drop(Extraction& x, Edge& e, const DripSite& site, int index, const Fallen& f, int group) {
  const DripSourceMotion& s = *e.source;
  const DripPose& pose = pose_at(s, f.detach_s);
  const glm::dvec3 lip(pose.matrix * glm::vec4(static_cast<float>(site.along_m), 0.0f, 0.0f, 1.0f));
  // The air as it was when it let go: a fall takes a second or two, a gust several.
  const glm::dvec3 wind = wind_at(x, f.detach_s), air = wind * double(s.set.wind);
  const double blows = glm::length(air);
  // Most drops let go in the same cell of wind as the drop before.
  if (const glm::ivec3 cell = DripSurfaces::cell_of(s, wind); !e.last || e.cell != cell || e.pose != pose.number) {
    e.last = &x.motion.surfaces->falls(s, pose, wind);
    e.cell = cell;
    e.pose = pose.number;
  }
  const double ground = (*e.last)[static_cast<std::size_t>(index)];
  const double diameter = diameter_mm_of(f.volume_m3 / group), terminal = terminal_speed_mps(diameter);
  const auto place = [&](double age) {
    const DripFall fall = fall_after(terminal, age, blows);
    return lip + glm::dvec3(air.x * fall.drift_s, -fall.fallen_m - 0.5e-3 * diameter, air.z * fall.drift_s);
  };
  const double age = x.time_s - f.detach_s, fallen = fallen_m_after(terminal, age);
  // What is far out of the picture, or has landed far off, is left before the costlier questions.
  if (fallen < ground) {
    if (!e.site_in_view) return;
    const glm::dvec3 about = lip - glm::dvec3(0.0, fallen, 0.0) - x.camera.position_m;
    const double sways = blows * age, trail = terminal * std::max(static_cast<double>(x.camera.exposure_s), f.gap_s);
    if (!inside(x.frustum, about, 0.1 + sways + trail)) return;
  } else if (!e.site_near || ground >= longest_fall_m) {
    return;
  }
  const auto looks =
      random_bits(glm::uvec4(s.seed, static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(f.k), 0x6c6f6f6bu));
  if (fallen >= ground) {
    const double landed = std::min(time_to_fall_s(terminal, ground), age);
    if (age - landed > landing_memory_s) return;
    const DripFall fall = fall_after(terminal, landed, blows);
    const glm::vec3 v(air.x * fall.drift_share, -fall.fall_speed_mps, air.z * fall.drift_share);
    glm::dvec3 at = lip + glm::dvec3(air.x * fall.drift_s, -ground, air.z * fall.drift_s);
    x.frame.landings.push_back({at, f.detach_s + landed, static_cast<float>(diameter), v, looks});
    return;
  }
  FrameDrip drop{};
  const double open = x.camera.exposure_s;
  const DripFall fall = fall_after(terminal, age, blows);
  drop.place_m = lip + glm::dvec3(air.x * fall.drift_s, -fall.fallen_m - 0.5e-3 * diameter, air.z * fall.drift_s);
  drop.velocity_mps = glm::vec3(air.x * fall.drift_share, -fall.fall_speed_mps, air.z * fall.drift_share);
  if (open > 1e-6) drop.velocity_mps = glm::vec3((drop.place_m - place(std::max(age - open, 0.0))) / open);
  drop.diameter_mm = static_cast<float>(diameter);
  // It swings from the neck's shape about the sphere, at its second mode, until the air flattens it (Beard and Chuang
  // 1987): omega^2 = 8 sigma / (rho a^3), dying away in a^2 / (5 nu) (shared physics, section 1).
  const double a = 0.5e-3 * diameter, omega = std::sqrt(8.0 * drip_surface_tension / (drip_water_density * a * a * a));
  const double settled = std::min(fall.fall_speed_mps / terminal, 1.0);
  drop.stretch = static_cast<float>(glm::mix(1.0 + 0.35 * std::exp(-5e-6 * age / (a * a)) * std::cos(omega * age),
                                             axis_ratio(diameter), settled * settled));
  if (group > 1 || (age < thread_s &&
                    neck_weber(f.volume_m3 / group / std::max(f.gap_s / group, 1e-6), s.set.lip_radius_mm) > 4.0)) {
    // A thread as long as the way to the drop before, of the water that is in it.
    const double length = std::max(fall.fall_speed_mps, 0.3) * f.gap_s;
    const double wide = std::sqrt(4.0 * f.volume_m3 / (std::numbers::pi * std::max(length, 1e-4)));
    drop.diameter_mm = static_cast<float>(diameter_mm_of(f.volume_m3));
    drop.stretch = static_cast<float>(std::clamp(length / wide, 1.0, 400.0));
  }
  drop.seed = looks;
  add_seen(x, e, site, lip, drop);
}

void add_bead(Extraction& x, Edge& e, const DripSite& site, int index, double water, std::int64_t fallen) {
  const DripSourceMotion& s = *e.source;
  const double volume = water - drip_threshold_m3(s, index, fallen - 1);
  if (!(volume > 1e-4 * s.drop_m3)) return;
  const glm::dvec3 lip(pose_at(s, x.time_s).matrix * glm::vec4(static_cast<float>(site.along_m), 0.0f, 0.0f, 1.0f));
  const double full = std::min(volume / s.drop_m3, 1.0);
  FrameDrip bead{};
  bead.diameter_mm = static_cast<float>(diameter_mm_of(volume));
  bead.stretch = static_cast<float>(0.8 + 0.55 * full * full);  // a cap at first, then a pear
  // Its top stays at the lip.
  const double height = bead.diameter_mm * std::pow(bead.stretch, 2.0 / 3.0);
  bead.place_m = lip - glm::dvec3(0.0, 0.5e-3 * height, 0.0);
  bead.velocity_mps = glm::vec3(0.0f);
  bead.seed = random_bits(glm::uvec4(s.seed, static_cast<std::uint32_t>(index), 0u, 0x62656164u));
  add_seen(x, e, site, lip, bead);
}

void add_site(Extraction& x, Edge& e, int index, double earliest_drained) {
  const DripSourceMotion& s = *e.source;
  const DripSite site = drip_site(s, index);
  const glm::dvec3 lip(s.poses.back().matrix * glm::vec4(static_cast<float>(site.along_m), 0.0f, 0.0f, 1.0f));
  const double fall = (*e.falls)[static_cast<std::size_t>(index)];
  const double distance2 = distance2_to_way(x.camera.position_m, lip, fall);
  if (distance2 > drip_reach_m * drip_reach_m) return;
  const double water = site_water_m3(s, site, e.now.drained_m2);
  const std::int64_t fallen = drops_fallen(s, index, water);
  if (e.in_view) add_bead(x, e, site, index, water, fallen);
  // Its whole way, as wide as wind makes it.
  const double aside = 0.1 + glm::length(e.wind) * s.set.wind * 0.1 * std::min(fall, 20.0) + 0.2;
  e.site_in_view =
      e.in_view && box_touches(x.frustum, glm::vec3(lip - glm::dvec3(0.0, 0.5 * fall, 0.0) - x.camera.position_m),
                               glm::vec3(aside, 0.5 * fall + 0.1, aside));
  e.site_near = e.near && distance2 <= drip_landing_reach_m * drip_landing_reach_m;
  if (!e.site_in_view && !e.site_near) return;
  const std::int64_t first =
      drops_fallen(s, index, site_water_m3(s, site, e.site_near ? earliest_drained : e.in_air_m2));
  if (first >= fallen) return;
  const double per_drained = site.share * s.set.length_m / s.sites;
  const auto detached = [&](std::int64_t k) {
    return time_of_drained(s, (drip_threshold_m3(s, index, k) - site.phase * s.drop_m3) / per_drained);
  };
  const double hz = e.now.outflow_m2ps * per_drained / s.drop_m3;
  std::int64_t group = 1;
  while (hz > fastest_site_hz * static_cast<double>(group)) group *= 2;
  std::int64_t k = (first + group - 1) / group * group;
  double before = k > 0 ? detached(k - group) : s.flows.front().time_s,
         threshold = drip_threshold_m3(s, index, k - group);
  for (; k < fallen; k += group) {
    const double next = drip_threshold_m3(s, index, k);
    const double when = time_of_drained(s, (next - site.phase * s.drop_m3) / per_drained);
    if (when > x.time_s) break;
    const double volume = next - threshold;
    threshold = next;
    add_drop(x, e, site, index, {when, volume, k, when - before}, static_cast<int>(group));
    before = when;
  }
}

// False: nothing of it is near or in view.
bool look_at_edge(Extraction& x, Edge& e) {
  const DripSourceMotion& s = *e.source;
  e.now = water_at(s, x.time_s);
  if (!s.wet_at_start && !(e.now.drained_m2 > 0.0)) return false;
  const glm::mat4& m = s.poses.back().matrix;
  const glm::dvec3 a(m[3]), b(m * glm::vec4(s.set.length_m, 0.0f, 0.0f, 1.0f));
  const glm::dvec3 low = glm::min(a, b), high = glm::max(a, b);
  const auto distance = [&](double fall, double aside) {
    const glm::dvec3 l = low - glm::dvec3(aside, fall, aside), h = high + glm::dvec3(aside, 0.0, aside);
    return glm::length(x.camera.position_m - glm::clamp(x.camera.position_m, l, h));
  };
  if (distance(longest_fall_m, 0.0) > drip_reach_m) return false;
  e.wind = wind_at(x, x.time_s);
  e.falls = &x.motion.surfaces->falls(s, s.poses.back(), e.wind);
  const double fall = *std::max_element(e.falls->begin(), e.falls->end());
  // As far as wind carries a drop.
  const double aside = 0.1 + glm::length(e.wind) * s.set.wind * 0.1 * std::min(fall, 20.0);
  const glm::dvec3 from = low - glm::dvec3(aside, fall, aside), to = high + glm::dvec3(aside, 0.0, aside);
  e.in_view = distance(fall, aside) <= drip_reach_m &&
              box_touches(x.frustum, glm::vec3(0.5 * (from + to) - x.camera.position_m), glm::vec3(0.5 * (to - from)));
  e.near = distance(fall, aside) <= drip_landing_reach_m;
  return e.in_view || e.near;
}

void add_edge(Extraction& x, const DripSourceMotion& s) {
  Edge e{};
  e.source = &s;
  if (s.poses.empty() || x.frame.sources.size() >= 65000 || !look_at_edge(x, e)) return;
  e.number = static_cast<std::uint16_t>(x.frame.sources.size());
  x.frame.sources.push_back({s.set.opacity, s.set.edge_strength, s.set.edge_bias, s.set.elongation, s.set.published});
  const double fall = *std::max_element(e.falls->begin(), e.falls->end());
  e.buckets = static_cast<int>(fall / bucket_m) + 1;
  e.clusters.assign(static_cast<std::size_t>((static_cast<int>(s.set.length_m / piece_m) + 1) * e.buckets), 0);
  // The smallest drop falls longest.
  const double small = diameter_mm_of(s.drop_m3 * (1.0 - std::min(s.set.jitter, 0.9f)));
  const double in_air = time_to_fall_s(terminal_speed_mps(small), fall);
  const double window = in_air + (e.near ? landing_memory_s : 0.0);
  e.in_air_m2 = water_at(s, x.time_s - std::min(in_air, drip_memory_s)).drained_m2;
  const double earliest = water_at(s, x.time_s - std::min(window, drip_memory_s)).drained_m2;
  for (int i = 0; i < s.sites; ++i) add_site(x, e, i, earliest);
}

}  // namespace

std::shared_ptr<const FrameDrips> make_frame_drips(const DripMotion& motion, const FrameCamera& camera, int width,
                                                   int height, double time_s, std::size_t most) {
  const float aspect = static_cast<float>(width) / static_cast<float>(std::max(height, 1));
  Extraction x{motion,
               camera,
               frustum_of(view_projection_of(camera.orientation, camera.vertical_fov_rad, aspect, camera.near_m)),
               time_s,
               {},
               {}};
  if (!motion.surfaces) return nullptr;
  motion.surfaces->forget();
  know_winds(x);
  for (const DripSourceMotion& s : motion.sources) add_edge(x, s);
  FrameDrips& f = x.frame;
  f.reach_m = static_cast<float>(drip_reach_m);
  if (x.seen.size() > most) {
    const auto nearer = [](const Seen& a, const Seen& b) {
      return std::tie(a.distance2, a.drop.seed) < std::tie(b.distance2, b.drop.seed);
    };
    const auto cut = x.seen.begin() + static_cast<std::ptrdiff_t>(most);
    std::nth_element(x.seen.begin(), cut, x.seen.end(), nearer);
    f.reach_m = static_cast<float>(std::sqrt(cut->distance2));
    x.seen.resize(most);
    std::sort(x.seen.begin(), x.seen.end(), nearer);
  }
  f.drops.reserve(x.seen.size());
  for (const Seen& s : x.seen) f.drops.push_back(s.drop);
  std::stable_sort(f.landings.begin(), f.landings.end(),
                   [](const DripLanding& a, const DripLanding& b) { return a.time_s < b.time_s; });
  if (f.drops.empty() && f.landings.empty()) return nullptr;
  return std::make_shared<const FrameDrips>(std::move(f));
}

void extract_drips(const Registry& registry, Frame& frame, double time_s) {
  frame.drips.reset();
  if (frame.techniques.share(Effect::drips, DripRung::none) >= 1.0f) return;
  const DripMotion* motion = find_drip_motion(registry);
  if (motion && !motion->sources.empty())
    frame.drips = make_frame_drips(*motion, frame.camera, frame.width, frame.height, time_s);
}

}  // namespace petrichor
