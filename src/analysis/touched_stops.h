#pragma once
/// The stops that joint coordinates touch on the way to an equilibrium, and the quadratic model of the potential there.

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "analysis/joint_potential.h"

namespace flexarm {

/// How an axis touches stops.
struct Touch {
  int pressed = 0;         ///< direction of the stop (1 or -1, of increasing ways) against which the axis is pressed
  bool is_grazed = false;  ///< touches a stop, but neither presses against it nor is pulled away
  /// Presses so weakly against its stop that the push may come from the give of other stops alone. Against rigid stops,
  /// such an axis would graze.
  bool is_weak = false;

  /// Whether loads might as well move the axis away from its stop.
  bool may_leave() const { return is_grazed || is_weak; }
};

/// A part of a motion that one axis ends at a stop.
struct Encounter {
  std::size_t axis;
  double part;  ///< of the motion until then
  double way;   ///< of the axis
};

class TouchedStops {
 public:
  /// `at` must have been looked at by `potentials`. Both must outlive this object.
  TouchedStops(const JointPotentials& potentials, const JointPotential& at);

  /// The axes that graze stops.
  std::vector<std::size_t> grazing() const;
  /// The axes that may leave their stops.
  std::vector<std::size_t> free_to_leave() const;
  /// A force that may come from the give of stops alone [J].
  double weak_force() const { return weak_; }

  /// Takes away the stops of these axes, so that the model below holds for motions away from them.
  void open(const std::vector<std::size_t>& axes);
  /// Per axis: whether no motion may move it, since it grazes a stop that is not taken away.
  std::vector<bool> shut() const;
  /// The model of the potential: stops act on the axes that press against them, as springs to both sides. Other stops
  /// do not act.
  Eigen::VectorXd force() const;
  Eigen::MatrixXd curvature() const;
  /// The first end of a motion at a stop. `is_fixed`: axes that do not count. Returns false if there is none.
  bool meets(const Eigen::VectorXd& ways, const std::vector<bool>& is_fixed, Encounter& first) const;

 private:
  using Bound = JointPotentials::Bound;
  void note(const Bound& bound, const Eigen::VectorXd& force, double round_off);
  double depth(const Bound& bound) const;
  bool touches(const Bound& bound) const;
  int pressed(std::size_t axis) const { return is_open_[axis] ? 0 : touches_[axis].pressed; }
  bool encounter(const Bound& bound, double way, Encounter& met) const;

  const JointPotentials& potentials_;
  const JointPotential& at_;
  std::vector<Touch> touches_;  // per axis
  std::vector<bool> is_open_;
  double weak_ = 0;
};

}  // namespace flexarm
