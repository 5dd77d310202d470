#pragma once
/// Maxwell branches of a beam's material over a step of the energy-momentum family. (docs/notes/viscoelastic.md)

#include <Eigen/Core>

#include "math/lanes.h"
#include "model/beam_element.h"

namespace flexarm {

/// Coefficients of Maxwell branches, of several elements side by side, over a step in which the strain changes by s at
/// a constant rate. The strain e of a branch's spring is then exactly
///   e_1 = keeps e_0 + gains s  at the end,  e_mean = gains e_0 + yields s  on average,
/// and the work of the mean stress g C e_mean is exactly
///   e_mean . C s = (e_1 . C e_1 - e_0 . C e_0) / 2 + flow e_mean . C e_mean + excess (e_1 - e_0) . C (e_1 - e_0).
template <typename S>
struct MaxwellCoefficients {
  S modulus_ratio = S(0);                         ///< g [-]
  S keeps = S(1), gains = S(1), yields = S(0.5);  ///< [-]
  S flow = S(0), excess = S(0);                   ///< [-]; of the sign of the step
};

/// Returns the coefficients of a branch over a step [s], which may be negative.
MaxwellCoefficients<double> maxwell_coefficients(const MaxwellBranch& branch, double step);

template <typename S>
void set_lane(MaxwellCoefficients<S>& pack, int lane, const MaxwellCoefficients<double>& from) {
  set_lane(pack.modulus_ratio, lane, from.modulus_ratio);
  set_lane(pack.keeps, lane, from.keeps);
  set_lane(pack.gains, lane, from.gains);
  set_lane(pack.yields, lane, from.yields);
  set_lane(pack.flow, lane, from.flow);
  set_lane(pack.excess, lane, from.excess);
}

/// The branches of an element over a step. `begin`, `end`: strains e of the springs, `count` for each stiffness point;
/// `end` is output.
template <typename S, int Size = 6>
struct MaxwellBranches {
  using Strain = Eigen::Matrix<S, Size, 1>;
  int count = 0;
  const MaxwellCoefficients<S>* coefficients = nullptr;  ///< per branch
  const Strain* begin = nullptr;
  Strain* end = nullptr;
};

}  // namespace flexarm
