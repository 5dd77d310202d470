/// Tests that subnormal numbers are flushed to zero only while a FlushSubnormals object lives.
#include "math/flush_subnormals.h"

#include <limits>

#include <gtest/gtest.h>

namespace flexarm {
namespace {

double half(double value) {
  volatile double result = value;  // prevents evaluation at compile time
  result = 0.5 * result;
  return result;
}

TEST(FlushSubnormals, OnlyWhileItLives) {
  const double least = std::numeric_limits<double>::min();
  EXPECT_GT(half(least), 0);
#if defined(__SSE2__) || defined(__aarch64__)
  {
    const FlushSubnormals flush;
    EXPECT_EQ(half(least), 0);
    EXPECT_EQ(half(2 * least), least);
  }
#endif
  EXPECT_GT(half(least), 0);
}

}  // namespace
}  // namespace flexarm
