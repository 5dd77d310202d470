// Tests the ODE solver of the reference solutions on equations with known solutions.
#include <cmath>

#include <gtest/gtest.h>

#include "reference/ode.h"

namespace flexarm::test {
namespace {

TEST(Ode, HarmonicOscillatorToRoundOff) {
  const OdeFunction f = [](double, const Eigen::VectorXd& y) { return Eigen::Vector2d(y[1], -4 * y[0]); };
  const Eigen::VectorXd y = solve_ode(f, 0, 10, Eigen::Vector2d(1, 0));
  EXPECT_NEAR(y[0], std::cos(20.0), 1e-11);
  EXPECT_NEAR(y[1], -2 * std::sin(20.0), 1e-11);
}

TEST(Ode, TimeDependentRightHandSide) {
  const OdeFunction f = [](double t, const Eigen::VectorXd& y) {
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, y[0] * std::cos(t)));
  };
  const Eigen::VectorXd y = solve_ode(f, 1, 6, Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_NEAR(y[0], 2 * std::exp(std::sin(6.0) - std::sin(1.0)), 1e-11);
}

}  // namespace
}  // namespace flexarm::test
