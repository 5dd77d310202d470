#pragma once
/// The step over which tests move elements and nodes.

#include "elements/newmark_rule.h"

namespace flexarm::test {

constexpr double kStep = 0.3;  // s
/// Newmark's rule of it, with the dissipation of alpha = -0.1: beta = (1 - alpha)^2 / 4, gamma = 1/2 - alpha.
constexpr NewmarkRule kNewmarkRule{0.3025, 0.6, kStep};
/// Sums of some hundred terms of order one to a hundred.
constexpr double kRoundOff = 1e-12;

}  // namespace flexarm::test
