/// Tests forces at the end of a step that are extrapolated from means over steps.
#include "model/step_means.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flexarm {
namespace {

/// Returns the error of the extrapolated end value for steps of these lengths. The function is 2 + 3 t; `alternating`
/// is added to its means and subtracted from them in turns.
double error_at_end(const std::vector<double>& steps, double alternating) {
  StepMeans means;
  means.resize(1);
  double time = 0;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const double mean = 2 + 3 * (time + 0.5 * steps[n]);
    means.begin();
    means.impulse[0] = steps[n] * (mean + (n % 2 == 0 ? alternating : -alternating));
    means.end(steps[n]);
    time += steps[n];
  }
  return std::abs(means.at_end(0) - (2 + 3 * time));
}

// The extrapolation is of second order: a linearly growing force is known exactly, for any lengths of steps.
TEST(StepMeans, LeadToTheEndOfTheLastStep) {
  for (const std::vector<double>& steps :
       {std::vector<double>{0.1, 0.1, 0.1}, {0.1, 0.1, 0.02}, {0.02, 0.1, 0.1}, {0.3, 0.01, 0.2, 0.05}})
    EXPECT_LT(error_at_end(steps, 0), 1e-14);
}

// A part that flips its sign in every step vanishes from the output if the steps are equal.
TEST(StepMeans, HaveNothingThatAlternates) {
  EXPECT_LT(error_at_end({0.1, 0.1, 0.1, 0.1}, 5), 1e-13);
}

// A restart gives the force at an instant.
TEST(StepMeans, BeginAnewWithAForce) {
  StepMeans means;
  means.resize(1);
  means.restart({2.0});
  EXPECT_EQ(means.at_end(0), 2);
  double time = 0;
  for (const double step : {0.1, 0.04}) {
    means.begin();
    means.impulse[0] = step * (2 + 3 * (time + 0.5 * step));
    means.end(step);
    time += step;
  }
  EXPECT_NEAR(means.at_end(0), 2 + 3 * time, 1e-14);
}

}  // namespace
}  // namespace flexarm
