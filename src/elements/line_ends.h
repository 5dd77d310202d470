#pragma once
/// The geometry of a straight line between two points of the mechanism.

#include "model/force_element.h"
#include "model/state.h"

namespace flexarm {

using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// Returns the nodes of two points of different bodies, of which one at least moves: both, or the one that is not the
/// world.
std::vector<int> nodes_of(const NodePoint& first, const NodePoint& second);

/// Arms and distance of two points, `child` and `parent`, in world axes, at one instant or averaged over two.
struct LineEnds {
  Vector3 child_arm, parent_arm;
  Vector3 distance;  ///< from the parent's to the child's point [m]

  LineEnds(const NodePoint& child, const NodePoint& parent, const std::vector<NodePose>& poses);
  LineEnds(const NodePoint& child, const NodePoint& parent, const State& state);
  /// The mean with this weight of `b`.
  static LineEnds mean(const LineEnds& a, const LineEnds& b, double weight);

  double length() const { return distance.norm(); }
  /// Derivative of the length by {displacement, spin} of child and parent, world axes.
  Vector12 gradient() const;

 private:
  LineEnds(const Vector3& child, const Vector3& parent, const Vector3& way)
      : child_arm(child), parent_arm(parent), distance(way) {}
  LineEnds(const NodePoint& child, const NodePoint& parent, const NodePose& child_pose, const NodePose& parent_pose);
};

/// A line over a step. Its direction is that of the mean distance, divided by the mean length. A tension along it does
/// exactly the work -tension times the change of the length, and does not change momenta.
class LineStep {
 public:
  /// `at_end`: the direction is that at the end.
  LineStep(const LineEnds& begin, const LineEnds& end, bool at_end);

  /// Sets `residual` to minus the forces of a tension [N] on {displacement, spin} of child and parent, and, if asked
  /// for, `tangent` to its derivative by their motions at the end. `slope`: of the tension by the length at the end
  /// [N/m].
  void act(double tension, double slope, Vector12& residual, Matrix12* tangent) const;
  /// What act() gives as residual for a tension of 1 N.
  Vector12 direction() const;

 private:
  double weight_;
  LineEnds mean_;
  double length_;  // mean
  LineEnds end_;
};

}  // namespace flexarm
