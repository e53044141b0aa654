#include "engine/core/log.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "engine/core/bench_row.hpp"

namespace petrichor {
namespace {

TEST(Log, GoesToStandardErrorAndNotToStandardOutput) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  log_debug("unseen");
  log_info("{} drops", 42);
  log_warn("mind {}", "the {} braces");
  log_error("over");
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(said, "info: 42 drops\nwarning: mind the {} braces\nerror: over\n");
}

TEST(Log, LevelsFilter) {
  set_log_level(LogLevel::error);
  EXPECT_FALSE(is_logged(LogLevel::warn));
  EXPECT_TRUE(is_logged(LogLevel::error));
  set_log_level(LogLevel::off);
  EXPECT_FALSE(is_logged(LogLevel::error));
  set_log_level(LogLevel::info);
  EXPECT_TRUE(is_logged(LogLevel::info));
  EXPECT_FALSE(is_logged(LogLevel::debug));
}

TEST(Quantile, NearestRank) {
  EXPECT_EQ(quantile({}, 0.5), 0.0);
  EXPECT_EQ(quantile({7.0}, 0.95), 7.0);
  EXPECT_EQ(quantile({5, 1, 4, 2, 3}, 0.5), 3.0);
  EXPECT_EQ(quantile({5, 1, 4, 2, 3}, 0.0), 1.0);
  EXPECT_EQ(quantile({5, 1, 4, 2, 3}, 1.0), 5.0);
  std::vector<double> hundred;
  for (int i = 1; i <= 100; ++i) hundred.push_back(i);
  EXPECT_NEAR(quantile(hundred, 0.95), 95.0, 1.0);
}

}  // namespace
}  // namespace petrichor
