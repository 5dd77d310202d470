#pragma once
/// Scales of the increments of the unknowns.

#include <vector>

#include "model/degrees_of_freedom.h"
#include "model/increment_history.h"
#include "model/model.h"

namespace flexarm {

/// Scales of all unknowns: displacements count over the model's length scale, rotations in rad, and a multiplier of a
/// loop as the way by which its force moves the mechanism in a step. Where motions and loops leave nothing free, the
/// multipliers are all that Newton's method has to find.
class UnknownScales {
 public:
  UnknownScales(const Model& model, const DegreesOfFreedom& dof);

  /// Largest entry of an increment, [-] or rad; infinite where one is not finite. `step` [s]; 0: statics, where
  /// multipliers do not count.
  double norm(const Eigen::VectorXd& increment, double step) const;
  /// Largest entry of a residual: forces times the model's length scale, and moments [N m].
  double largest_moment(const Eigen::VectorXd& residual) const;
  /// Largest rotation among the entries [rad].
  double largest_rotation(const Eigen::VectorXd& increment) const;
  /// The next step is to be foreseen as the newest one would have been foreseen best.
  void choose_order(IncrementHistory& history) const;

 private:
  struct Multiplier {
    int equation;
    double arm;  // of its force [m], or 1
  };
  double length_ = 1, mass_ = 0;
  // Per equation; neither has multipliers.
  Eigen::ArrayXd scales_;     // [1/m], 1 of rotations
  Eigen::ArrayXd rotations_;  // 1 of those, else 0
  std::vector<Multiplier> multipliers_;
};

}  // namespace flexarm
