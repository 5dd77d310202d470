// Tests functions of time in several threads. The program is built with the thread sanitizer, which ends it with an
// error if threads have a data race.
#include <thread>

#include <gtest/gtest.h>

#include "flexarm/math/time_function.h"

namespace flexarm {
namespace {

constexpr const char* kTexts[] = {"t < 1 ? sin(2*_pi*t) : t^2", "0:0 1:50 2:0", "0:0:0 1:50:1 2:0:0", "7"};

double sum_of(const TimeFunction& function) {
  double sum = 0;
  for (int n = 0; n < 1000; ++n) sum += function(n * 2e-3);
  return sum;
}

/// Runs work(0) and work(1) in two threads. Both must return the same sum.
template <class Work>
void run_twice(const Work& work) {
  double sums[2] = {0, 0};
  std::thread first([&] { sums[0] = work(0); }), second([&] { sums[1] = work(1); });
  first.join();
  second.join();
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_NE(sums[0], 0);
}

// Two models of one scene have such copies. The copies exist before and after the threads, so that their creation does
// not order the threads.
TEST(TimeFunction, CopiesMayBeEvaluatedAtTheSameTime) {
  for (const char* text : kTexts) {
    const TimeFunction original = TimeFunction::parse(text), copies[] = {original, original};
    run_twice([&copies](int thread) { return sum_of(copies[thread]); });
  }
}

// Two simulations of one scene make such copies.
TEST(TimeFunction, MayBeCopiedAtTheSameTime) {
  for (const char* text : kTexts) {
    const TimeFunction original = TimeFunction::parse(text);
    run_twice([&original](int) { return sum_of(TimeFunction(original)); });
  }
}

}  // namespace
}  // namespace flexarm
