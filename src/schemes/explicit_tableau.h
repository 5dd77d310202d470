#pragma once
/// Coefficients of explicit Runge-Kutta methods.

#include <vector>

namespace flexarm {

/// Stage s is evaluated at the time t + times[s] h and the value y + h sum_r stages[s][r] k_r; the step ends at
/// y + h sum_s weights[s] k_s.
struct ExplicitTableau {
  std::vector<std::vector<double>> stages;  ///< per stage: coefficients of the stages before it
  std::vector<double> weights, times;       ///< per stage
};

/// The classical method of order 4 (Kutta 1901).
const ExplicitTableau& rk4_tableau();
/// The method of order 8 of DOP853, without its error estimate (Hairer, Norsett and Wanner, Solving Ordinary
/// Differential Equations I, 1993, II.5).
const ExplicitTableau& dop853_tableau();

}  // namespace flexarm
