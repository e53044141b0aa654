#include "systems/director/choose.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace petrichor {
namespace {

// Ladders, times and a question by chance; `rungs` of each of the first `effects` effects, one of the others.
struct Exam {
  std::vector<Ladder> ladders;
  CostTable table;
  Question question;

  Exam(std::mt19937& random, std::size_t effects, int rungs) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (std::size_t e = 0; e < effect_count; ++e) {
      const bool is_size = e == static_cast<std::size_t>(Effect::resolution);
      const int count = is_size ? 3 : e < effects ? rungs : 1;
      Ladder l;
      l.effect = static_cast<Effect>(e);
      l.rungs.resize(static_cast<std::size_t>(count));
      for (Rung& r : l.rungs) r.chart_ms = 20.0 * unit(random), r.chart_error = unit(random);
      ladders.push_back(l);
      table.ms[e].resize(static_cast<std::size_t>(count));
      for (auto& sizes : table.ms[e]) {
        const double ms = 20.0 * unit(random);
        sizes = {0.4 * ms, 0.6 * ms, ms};
      }
      question.coverage[e] = unit(random);
      question.now[e] = static_cast<int>(unit(random) * count);
      question.allowed[e].assign(static_cast<std::size_t>(count), 0);
      for (char& a : question.allowed[e]) a = unit(random) < 0.8;
      question.allowed[e][static_cast<std::size_t>(question.now[e])] = 1;
    }
    question.ladders = &ladders;
    question.table = &table;
    question.spread = 1.0 + 0.3 * unit(random);
    question.trade_penalty = unit(random) < 0.5 ? 0.1 : 0.0;
    question.limit_ms = 10.0 + 120.0 * unit(random);
  }
};

// The least visible error with its penalties, of all combinations.
double by_trying_all(const Question& q, bool& fits) {
  double best = std::numeric_limits<double>::infinity();
  Rungs rungs{};
  while (true) {
    bool allowed = true;
    int changes = 0, worse = 0;
    for (std::size_t e = 0; e < effect_count; ++e) {
      const auto& of = (*q.ladders)[e].rungs;
      allowed &= q.allowed[e][static_cast<std::size_t>(rungs[e])] != 0;
      changes += rungs[e] != q.now[e];
      worse += of[static_cast<std::size_t>(rungs[e])].chart_error > of[static_cast<std::size_t>(q.now[e])].chart_error;
    }
    if (allowed && expected_ms(q, rungs) * q.spread <= q.limit_ms)
      best = std::min(best, visible_error(q, rungs) + 0.002 * changes + q.trade_penalty * worse);
    std::size_t e = 0;
    while (e < effect_count && ++rungs[e] == static_cast<int>((*q.ladders)[e].rungs.size())) rungs[e++] = 0;
    if (e == effect_count) break;
  }
  fits = best < std::numeric_limits<double>::infinity();
  return best;
}

double with_penalties(const Question& q, const Answer& a) {
  double value = a.error;
  for (std::size_t e = 0; e < effect_count; ++e) {
    const auto& of = (*q.ladders)[e].rungs;
    value += a.rungs[e] != q.now[e] ? 0.002 : 0.0;
    if (of[static_cast<std::size_t>(a.rungs[e])].chart_error > of[static_cast<std::size_t>(q.now[e])].chart_error)
      value += q.trade_penalty;
  }
  return value;
}

TEST(Choose, FindsWhatTryingAllFinds) {
  std::mt19937 random(7);
  int fitting = 0;
  for (int exam = 0; exam < 150; ++exam) {
    const Exam e(random, 5, 4);
    bool fits = false;
    const double best = by_trying_all(e.question, fits);
    const Answer answer = choose(e.question);
    ASSERT_EQ(answer.fits, fits) << exam;
    for (std::size_t k = 0; k < effect_count; ++k)
      ASSERT_TRUE(e.question.allowed[k][static_cast<std::size_t>(answer.rungs[k])]);
    if (!fits) continue;
    ++fitting;
    EXPECT_LE(answer.ms * e.question.spread, e.question.limit_ms * (1.0 + 1e-12));
    EXPECT_NEAR(with_penalties(e.question, answer), best, 5e-5) << exam;  // tie-breakers weigh less
  }
  EXPECT_GT(fitting, 20);
}

// All effects with seven rungs each, which nobody could try one by one.
TEST(Choose, IsQuickWithManyLadders) {
  std::mt19937 random(3);
  for (int exam = 0; exam < 5; ++exam) {
    const Exam e(random, effect_count, 7);
    const Answer answer = choose(e.question);
    EXPECT_TRUE(answer.ms > 0.0);
  }
}

}  // namespace
}  // namespace petrichor
