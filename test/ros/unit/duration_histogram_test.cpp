// Tests the histogram of durations from which the node reports quantiles.
#include "ros/duration_histogram.h"

#include <gtest/gtest.h>

namespace flexarm::node {
namespace {

TEST(DurationHistogram, BoundsQuantilesFromAbove) {
  DurationHistogram histogram;
  for (int n = 1; n <= 1000; ++n) histogram.add(n * 1e-6);
  const double width = std::exp2(1.0 / 8);
  for (const double part : {0.5, 0.99, 0.999}) {
    EXPECT_GE(histogram.quantile(part), part * 1e-3);
    EXPECT_LE(histogram.quantile(part), part * 1e-3 * width);
  }
  EXPECT_EQ(histogram.largest(), 1e-3);
  EXPECT_EQ(histogram.quantile(1), 1e-3);
  EXPECT_EQ(histogram.count(), 1000u);
}

TEST(DurationHistogram, TakesAnyDuration) {
  DurationHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), 0);
  for (const double seconds : {0.0, -1e-9, 1e-12, 1e9}) histogram.add(seconds);
  EXPECT_LE(histogram.quantile(0.5), 2e-7);
  EXPECT_EQ(histogram.largest(), 1e9);
  histogram.clear();
  EXPECT_EQ(histogram.count(), 0u);
}

}  // namespace
}  // namespace flexarm::node
