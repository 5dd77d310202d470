#pragma once
/// Scales of the unknowns, for norms of Newton updates and residuals.

#include <vector>

#include "model/degrees_of_freedom.h"
#include "model/increment_history.h"
#include "model/model.h"

namespace flexarm {

/// Scales of all unknowns. Displacements are divided by the model's length scale; rotations are in rad. The multiplier
/// of a loop counts as the displacement that its force causes in a step. Multipliers matter if motions and loops leave
/// no other unknowns.
class UnknownScales {
 public:
  UnknownScales(const Model& model, const DegreesOfFreedom& dof);

  /// Largest scaled entry of an increment, [-] or rad; infinite if an entry is not finite. `step` [s]; 0: statics,
  /// where multipliers do not count.
  double norm(const Eigen::VectorXd& increment, double step) const;
  /// Largest entry of a residual as a moment [N m]: forces are multiplied by the model's length scale.
  double largest_moment(const Eigen::VectorXd& residual) const;
  /// Largest rotation among the entries of an increment [rad].
  double largest_rotation(const Eigen::VectorXd& increment) const;
  /// Chooses the order of extrapolation for the next step: the order that would have predicted the newest increment
  /// best.
  void choose_order(IncrementHistory& history) const;

 private:
  struct Multiplier {
    int equation;
    double arm;  // lever arm of a multiplier that is a moment [m]; 1 for a force
  };
  double length_ = 1, mass_ = 0;
  // Per equation; zero for multipliers.
  Eigen::ArrayXd scales_;     // [1/m]; 1 for rotations
  Eigen::ArrayXd rotations_;  // 1 for rotations, else 0
  std::vector<Multiplier> multipliers_;
};

}  // namespace flexarm
