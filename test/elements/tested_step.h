#pragma once
/// Length, rule and round-off of the step in tests of elements and nodes.

#include "study_schemes/newmark_rule.h"

namespace flexarm::test {

constexpr double kStep = 0.3;  // s
/// Newmark's rule for this step, with the dissipation of alpha = -0.1: beta = (1 - alpha)^2 / 4, gamma = 1/2 - alpha.
constexpr NewmarkRule kNewmarkRule{0.3025, 0.6, kStep};
/// Round-off of sums of some hundred terms of size 1 to 100.
constexpr double kRoundOff = 1e-12;

}  // namespace flexarm::test
