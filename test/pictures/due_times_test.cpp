// Tests at which times pictures of a run are due.
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "pictures/due_times.h"

namespace flexarm::pictures {
namespace {

/// The numbers of the rows that are shown, of rows at distances of `step` [s] from `first` [s] on.
std::vector<int> shown_rows(DueTimes due, int rows, double step, double first = 0) {
  std::vector<int> shown;
  for (int n = 0; n < rows; ++n) {
    const double time = first + n * step;
    if (!due.is_due(time)) continue;
    due.note(time);
    shown.push_back(n);
  }
  return shown;
}

// The sum of a million times 0.1 is 1.3e-6 larger than 100000, so with sums of periods rows would be left out.
TEST(DueTimes, RoundOffDoesNotAddUp) {
  DueTimes due(10);
  for (int n = 0; n <= 1000000; ++n) {
    const double time = n / 10.0;
    ASSERT_TRUE(due.is_due(time)) << n;
    due.note(time);
    ASSERT_FALSE(due.is_due(time + 0.099)) << n;
  }
}

TEST(DueTimes, BeginWithTheFirstInstant) {
  const std::vector<int> shown = shown_rows(DueTimes(50), 1001, 0.001, 7.003);
  ASSERT_EQ(shown.size(), 51U);
  for (std::size_t k = 0; k < shown.size(); ++k) EXPECT_EQ(shown[k], 20 * static_cast<int>(k));
}

// All rows are shown if they are farther apart than periods; if they are nearer, as many as there are periods.
TEST(DueTimes, HaveTheRateOrThatOfTheRows) {
  for (const double periods : {1.0, 1.3, 1.5, 1.9, 2.0, 7.7})
    EXPECT_EQ(shown_rows(DueTimes(30), 1000, periods / 30).size(), 1000U) << periods;
  for (const double periods : {0.95, 0.6, 0.5, 0.03})
    EXPECT_NEAR(static_cast<double>(shown_rows(DueTimes(30), 3000, periods / 30).size()), 3000 * periods, 1) << periods;
}

// After a gap the next time is one of the same ones, and less than a period later.
TEST(DueTimes, GapsAreLeftOut) {
  DueTimes due(10);
  due.note(0);
  ASSERT_TRUE(due.is_due(0.734));
  due.note(0.734);
  EXPECT_FALSE(due.is_due(0.799));
  EXPECT_TRUE(due.is_due(0.8));
}

// If every second instant of 0, 1, ... 5 is dropped, the next ones are at 6, 8 and so on.
TEST(DueTimes, OfThinnedOutRuns) {
  DueTimes due(1);
  for (int n = 0; n < 6; ++n) due.note(n);
  due.thin_out();
  EXPECT_TRUE(due.is_due(6));
  due.note(6);
  EXPECT_FALSE(due.is_due(7));
  EXPECT_TRUE(due.is_due(8));
}

}  // namespace
}  // namespace flexarm::pictures
