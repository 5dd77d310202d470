#pragma once
/// Solves ordinary differential equations to nearly round-off, as an independent reference for dynamics.

#include <functional>

#include <Eigen/Core>

namespace flexarm::test {

/// Right-hand side of y' = f(t, y).
using OdeFunction = std::function<Eigen::VectorXd(double t, const Eigen::VectorXd& y)>;

/// Solution at time `to` of y' = f(t, y), y(from) = `start`, by Gragg-Bulirsch-Stoer extrapolation (modified midpoint
/// rule, even sequence, up to order 16) with step control.
/// @param tolerance  largest local error, relative to 1 + |y|
/// @throws std::runtime_error if the step becomes too small.
Eigen::VectorXd solve_ode(const OdeFunction& f, double from, double to, const Eigen::VectorXd& start,
                          double tolerance = 1e-13);

}  // namespace flexarm::test
