// Tests the extrapolation of the predictor from the increments of past steps.
#include "model/increment_history.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace flexarm {
namespace {

constexpr double kRoundOff = 64 * std::numeric_limits<double>::epsilon();

/// Lengths of steps, oldest first. The last step may go backwards, as in a composed scheme.
const std::vector<std::vector<double>> kSteps = {
    {1, 1, 1, 1}, {1, 1, 0.5, 0.5}, {0.2, 0.4, 0.8, 1.6}, {0.41, 0.41, -0.66, 0.41}, {0.5, 1, 1, -0.3}};

double power(double t, int order) {
  return std::pow(t, order);
}

/// Returns the increments of t^order over the steps, and writes the time that is reached to `time`.
IncrementHistory history_of(const std::vector<double>& steps, int order, double& time) {
  IncrementHistory history;
  time = 3;
  for (const double step : steps) {
    history.push(step, 1)[0] = power(time + step, order) - power(time, order);
    time += step;
  }
  return history;
}

// Order p predicts polynomials up to degree p + 1 exactly from p + 1 increments.
TEST(IncrementHistory, IsExactForPolynomials) {
  for (const std::vector<double>& steps : kSteps)
    for (int order = 0; order <= IncrementHistory::kHighestOrder; ++order)
      for (int power_of_time = 0; power_of_time <= order + 1; ++power_of_time) {
        double time = 0;
        const IncrementHistory history = history_of(steps, power_of_time, time);
        const double step = 0.25;
        const IncrementHistory::Weights weights = history.weights(order, 0, step);
        if (weights[0] == 0) continue;  // such weights would amplify errors
        double foreseen = 0, scale = 0;
        for (int i = 0; i <= order; ++i) {
          foreseen += weights[i] * history.increments[i][0];
          scale += std::abs(weights[i] * history.increments[i][0]);
        }
        scale += power(time + step, power_of_time);
        EXPECT_NEAR(foreseen, power(time + step, power_of_time) - power(time, power_of_time), kRoundOff * scale)
            << "order " << order << ", t^" << power_of_time;
      }
}

TEST(IncrementHistory, EqualStepsHaveTheBinomialWeights) {
  double time = 0;
  const IncrementHistory history = history_of({1, 1, 1, 1}, 1, time);
  const IncrementHistory::Weights expected[] = {{1, 0, 0, 0}, {2, -1, 0, 0}, {3, -3, 1, 0}};
  for (int order = 0; order <= IncrementHistory::kHighestOrder; ++order)
    for (std::size_t i = 0; i < expected[order].size(); ++i)
      EXPECT_NEAR(history.weights(order, 0, 1)[i], expected[order][i], kRoundOff);
}

TEST(IncrementHistory, RefusesWhatItDoesNotKnowAndWhatBlowsUp) {
  IncrementHistory history;
  EXPECT_FALSE(history.holds_for(1));
  EXPECT_EQ(history.weights(0, 0, 1)[0], 0);
  history.push(1, 1)[0] = 0.5;
  EXPECT_TRUE(history.holds_for(1));
  EXPECT_EQ(history.weights(0, 0, 2)[0], 2);
  EXPECT_EQ(history.weights(1, 0, 1)[0], 0) << "one increment";
  for (int k = 0; k < 3; ++k) history.push(1e-3, 1)[0] = 0.5e-3;
  EXPECT_EQ(history.weights(2, 0, 1)[0], 0) << "a long way behind short steps";
  EXPECT_NE(history.weights(2, 0, 1e-3)[0], 0);
}

TEST(IncrementHistory, ForgetsIncrementsOfOtherUnknowns) {
  IncrementHistory history;
  for (int k = 0; k < 3; ++k) history.push(1, 2)[0] = 1;
  EXPECT_FALSE(history.holds_for(3));
  history.push(1, 3);
  EXPECT_TRUE(history.holds_for(3));
  EXPECT_EQ(history.count, 1);
}

}  // namespace
}  // namespace flexarm
