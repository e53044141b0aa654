#include "engine/ecs/bench_ecs.hpp"

#include <chrono>
#include <numeric>
#include <utility>

#include "engine/core/random.hpp"
#include "engine/ecs/registry.hpp"

namespace petrichor {
namespace {

struct Position {
  float x = 0, y = 0, z = 0;
};
struct Velocity {
  float x = 1, y = 2, z = 3;
};
struct Mass {
  float kg = 1;
};
struct Age {
  float s = 0;
};

// Walks write what they read, so that no compiler can leave them out.
void walk_2(Registry& r) {
  r.view<Position, const Velocity>().each([](Position& p, const Velocity& v) {
    p.x += v.x;
    p.y += v.y;
    p.z += v.z;
  });
}
void walk_3(Registry& r) {
  r.view<Position, const Velocity, const Mass>().each([](Position& p, const Velocity& v, const Mass& m) {
    p.x += v.x * m.kg;
    p.y += v.y * m.kg;
    p.z += v.z * m.kg;
  });
}
void walk_4(Registry& r) {
  r.view<Position, const Velocity, const Mass, Age>().each([](Position& p, const Velocity& v, const Mass& m, Age& a) {
    p.x += v.x * m.kg;
    p.y += v.y * m.kg;
    p.z += v.z * m.kg;
    a.s += 0.01f;
  });
}

std::vector<Entity> fill_2(Registry& r, std::size_t n) {
  std::vector<Entity> made;
  made.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Entity e = r.create();
    r.emplace<Position>(e);
    r.emplace<Velocity>(e);
    made.push_back(e);
  }
  return made;
}

std::vector<Entity> shuffled(std::vector<Entity> list, std::uint32_t seed) {
  RandomStream random(seed);
  for (std::size_t i = list.size(); i > 1; --i) {
    std::swap(list[i - 1], list[random.below(static_cast<std::uint32_t>(i))]);
  }
  return list;
}

// Runs prepare() untimed and work() timed, `times` over.
template <class Prepare, class Work>
BenchRow timed(std::string name, std::size_t n, int times, Prepare prepare, Work work) {
  std::vector<double> samples_ms;
  for (int i = 0; i < times; ++i) {
    prepare();
    const auto start = std::chrono::steady_clock::now();
    work();
    samples_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  return {"ecs/" + std::move(name), std::to_string(n), "", quantile(samples_ms, 0.5), quantile(samples_ms, 0.95), {}};
}

void bench_walks(std::vector<BenchRow>& rows, std::size_t n, int times) {
  const auto nothing = [] {};
  Registry r;
  const std::vector<Entity> all = fill_2(r, n);
  for (const Entity e : all) r.emplace<Mass>(e);
  for (const Entity e : all) r.emplace<Age>(e);
  walk_4(r);  // the first touch of fresh memory belongs to no row
  rows.push_back(timed("iterate_2", n, times, nothing, [&] { walk_2(r); }));
  rows.push_back(timed("iterate_3", n, times, nothing, [&] { walk_3(r); }));
  rows.push_back(timed("iterate_4", n, times, nothing, [&] { walk_4(r); }));
}

void bench_shuffled(std::vector<BenchRow>& rows, std::size_t n, int times) {
  const auto nothing = [] {};
  Registry r;
  std::vector<Entity> all(n);
  for (Entity& e : all) e = r.create();
  for (const Entity e : shuffled(all, 1)) r.emplace<Position>(e);
  for (const Entity e : shuffled(all, 2)) r.emplace<Velocity>(e);
  walk_2(r);
  rows.push_back(timed("iterate_2_shuffled", n, times, nothing, [&] { walk_2(r); }));
  rows.push_back(timed("sort_as", n, 1, nothing, [&] { r.sort_as<Velocity, Position>(); }));
  rows.push_back(timed("iterate_2_sorted", n, times, nothing, [&] { walk_2(r); }));
}

void bench_changes(std::vector<BenchRow>& rows, std::size_t n, int times) {
  Registry r;
  std::vector<Entity> all;
  rows.push_back(timed(
      "create_with_2", n, times, [&] { r = Registry(); }, [&] { all = fill_2(r, n); }));
  rows.push_back(timed(
      "remove_and_add", n, times, [] {},
      [&] {
        for (const Entity e : all) r.remove<Velocity>(e);
        for (const Entity e : all) r.emplace<Velocity>(e);
      }));
  rows.push_back(timed(
      "destroy", n, times,
      [&] {
        r = Registry();
        all = fill_2(r, n);
      },
      [&] {
        for (const Entity e : all) r.destroy(e);
      }));
}

}  // namespace

std::vector<BenchRow> bench_ecs() {
  std::vector<BenchRow> rows;
  bench_walks(rows, 50'000, 101);
  bench_walks(rows, 1'000'000, 21);
  bench_shuffled(rows, 1'000'000, 11);
  bench_changes(rows, 50'000, 21);
  bench_changes(rows, 1'000'000, 5);
  return rows;
}

}  // namespace petrichor
