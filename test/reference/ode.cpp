// An ODE solver of high accuracy (extrapolation) for reference solutions; see ode.h.
#include "reference/ode.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace flexarm::test {
namespace {

constexpr int kColumns = 8;

/// Gragg's modified midpoint rule with `count` (even) sub-steps. Its error contains only even powers of the sub-step.
Eigen::VectorXd modified_midpoint(const OdeFunction& f, double t, const Eigen::VectorXd& y, double step, int count) {
  const double h = step / count;
  Eigen::VectorXd before = y, now = y + h * f(t, y);
  for (int i = 1; i < count; ++i) {
    Eigen::VectorXd next = before + 2 * h * f(t + i * h, now);
    before = std::move(now);
    now = std::move(next);
  }
  return 0.5 * (before + now + h * f(t + step, now));
}

}  // namespace

Eigen::VectorXd solve_ode(const OdeFunction& f, double from, double to, const Eigen::VectorXd& start,
                          double tolerance) {
  Eigen::VectorXd y = start;
  const double length = to - from, smallest = 1e-10 * std::abs(length);
  double t = from, step = length / 16;
  while (std::abs(to - t) > smallest) {
    if (std::abs(step) > std::abs(to - t)) step = to - t;
    std::array<Eigen::VectorXd, kColumns> table;  // last row of Neville's scheme
    int used = 0;
    for (int k = 0; k < kColumns && used == 0; ++k) {
      Eigen::VectorXd value = modified_midpoint(f, t, y, step, 2 * (k + 1));
      for (int j = 0; j < k; ++j) {
        const double ratio = double(k + 1) / double(k - j);
        Eigen::VectorXd better = value + (value - table[j]) / (ratio * ratio - 1);
        table[j] = std::move(value);
        value = std::move(better);
      }
      const double error = k > 2 ? (value - table[k - 1]).cwiseAbs().maxCoeff() : 1e300;
      table[k] = std::move(value);
      if (error <= tolerance * (1 + y.cwiseAbs().maxCoeff())) used = k + 1;
    }
    if (used == 0) {
      step *= 0.5;
      if (std::abs(step) < smallest) throw std::runtime_error("solve_ode: the step became too small");
      continue;
    }
    y = table[used - 1];
    t += step;
    if (used < kColumns) step *= 1.5;
  }
  return y;
}

}  // namespace flexarm::test
