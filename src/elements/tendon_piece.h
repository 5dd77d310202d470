#pragma once
/// Geometry of a line that runs over points and circles of moving bodies: one piece, straight from one guide to the
/// next. (docs/notes/lines.md)

#include <cmath>

#include "model/force_element.h"

namespace flexarm {

/// A place that a line runs over: a point (radius 0), or a circle to which it leads tangentially. Fixed to a node or
/// the world. An angle on the circle counts from the first axis towards the second one.
struct GuidePlace {
  int node = -1;
  Vector3 centre = Vector3::Zero();                             ///< from the node, in its frame; or in the world [m]
  Vector3 first = Vector3::UnitX(), second = Vector3::UnitY();  ///< axes of the circle's plane, in the same frame
  double radius = 0;                                            ///< [m]; 0: a point
  double sense = 1;  ///< 1: the line turns from the first axis towards the second one; -1: the other way

  bool is_circle() const { return radius > 0; }
  /// The point of the circle at an angle, or the point itself; same frame as `centre`.
  Vector3 at(double angle) const { return centre + radius * (std::cos(angle) * first + std::sin(angle) * second); }
};

/// The angle that differs from `angle` by whole turns and is nearest to `reference` [rad].
double nearest_turn(double angle, double reference);

/// A linear functional of a piece: straight * length + begin * angle at its first guide + end * angle at its second.
struct PieceWeights {
  double straight = 0;        ///< [-]
  double begin = 0, end = 0;  ///< [m/rad]

  PieceWeights operator-(const PieceWeights& other) const {
    return {straight - other.straight, begin - other.begin, end - other.end};
  }
};

/// A straight piece at one instant. Angles are those of the tangent points, and count over whole turns.
struct PieceState {
  double length = 0;          ///< [m]
  double begin = 0, end = 0;  ///< angles at the first and the second guide [rad]
  double value(const PieceWeights& weights) const {
    return weights.straight * length + weights.begin * begin + weights.end * end;
  }
};

using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// The change of a functional over a step. Derivatives are with respect to {displacement, spin} of the nodes of the
/// first and of the second guide at the end of the step, world axes.
struct PieceChange {
  Vector12 direction;        ///< its product with the motion over the step is exactly the change of the functional
  Vector12 end_gradient;     ///< derivative of the functional at the end
  Matrix12 direction_slope;  ///< derivative of `direction`
};

/// The poses of the two nodes of a piece; of the world for guides that are fixed there.
struct PiecePoses {
  NodePose first, second;
};

namespace tendon {

/// A guide at an instant, world axes. `arm`: from the node to the centre. `S`: double, or a number with derivatives.
template <class S>
struct GuideFrame {
  using V = Eigen::Matrix<S, 3, 1>;
  V centre, arm, first, second, normal;
};

}  // namespace tendon

/// A piece at one end of a step, with its guides.
struct PieceEnd {
  tendon::GuideFrame<double> first, second;
  PieceState state;
};

/// A straight piece of a line between two guides. Where it meets a circle, its projection into the circle's plane is
/// tangent. If there is no such line (a point inside the circle), all results are NaN.
class TendonPiece {
 public:
  TendonPiece(const GuidePlace& first, const GuidePlace& second) : first_(first), second_(second) {}
  const GuidePlace& first() const { return first_; }
  const GuidePlace& second() const { return second_; }

  /// The piece at an instant. Its angles differ from those of `near` by less than half a turn.
  PieceState find(const PiecePoses& poses, const PieceState& near) const;
  /// The same, faster if the angles differ little.
  PieceState follow(const PiecePoses& poses, const PieceState& near) const { return place(poses, near).state; }
  /// The same with the guides.
  PieceEnd place(const PiecePoses& poses, const PieceState& near) const;
  /// Gradient of a functional by {displacement, spin} of both nodes, world axes. `here`: the piece at these poses.
  Vector12 gradient(const PiecePoses& poses, const PieceState& here, const PieceWeights& weights) const;
  /// The change of a functional over a step, by a discrete gradient that depends on scalar products of the bodies'
  /// vectors only. So its forces and moments on both bodies have the sum zero. `at_end`: `direction` is the gradient at
  /// the end. `with_slope`: also find the derivatives.
  PieceChange change(const PieceEnd& begin, const PieceEnd& end, const PieceWeights& weights, bool at_end,
                     bool with_slope) const;

 private:
  PieceState state_at(const PieceEnd& guides, double begin, double end, const PieceState& near) const;

  GuidePlace first_, second_;
};

}  // namespace flexarm
