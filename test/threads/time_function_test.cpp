// Built with the thread sanitizer, which ends the program with an error where threads share what one of them changes.
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

/// Runs work(0) and work(1) in two threads; both must come to the same sum.
template <class Work>
void run_twice(const Work& work) {
  double sums[2] = {0, 0};
  std::thread first([&] { sums[0] = work(0); }), second([&] { sums[1] = work(1); });
  first.join();
  second.join();
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_NE(sums[0], 0);
}

// As two models of one scene have them. They live before and after the threads, so that nothing else orders these.
TEST(TimeFunction, CopiesMayBeEvaluatedAtTheSameTime) {
  for (const char* text : kTexts) {
    const TimeFunction original = TimeFunction::parse(text), copies[] = {original, original};
    run_twice([&copies](int thread) { return sum_of(copies[thread]); });
  }
}

// As two simulations of one scene make them.
TEST(TimeFunction, MayBeCopiedAtTheSameTime) {
  for (const char* text : kTexts) {
    const TimeFunction original = TimeFunction::parse(text);
    run_twice([&original](int) { return sum_of(TimeFunction(original)); });
  }
}

}  // namespace
}  // namespace flexarm
