#pragma once
/// Elimination of a joint's released coordinates in the plane: JointFront with {x, y, turn} at its nodes.

#include <algorithm>
#include <optional>
#include <vector>

#include "model/plane.h"
#include "solver/joint_front.h"

namespace flexarm {

/// A block of a node in the plane: columns are four numbers apart.
using PlanarBlock = Eigen::Map<Matrix3, 0, Eigen::OuterStride<4>>;
constexpr int kPlanarBlock = 12;

/// With one coordinate, or none, everything is projected; joints with more go through JointFront in space, where the
/// motions out of the plane, of which nothing comes, are given a stiffness of their own.
class PlanarJointFront {
 public:
  PlanarJointFront(const JointMap& joint, int variable, const DegreesOfFreedom& dof, const PlaneOfMotion& plane);

  int variable() const { return variable_; }
  bool has_master() const { return master_ >= 0; }

  /// `blocks`: the diagonal blocks of all variables; those of nodes are PlanarBlock.
  bool eliminate(const FoldMaps& maps, double* const* blocks);
  /// Forward elimination of a right-hand side: four numbers a node, and one value per scalar of the mechanism, of which
  /// the coordinates' are used.
  void forward(const FoldMaps& maps, double* nodes, double* scalars);
  void backward(const FoldMaps& maps, double* nodes, double* scalars);

 private:
  /// The same in space: blocks and values as JointFront has them.
  struct InSpace {
    InSpace(const JointMap& joint, int variable, const DegreesOfFreedom& dof);
    /// Its coordinates, from all scalars and back.
    void take(const double* scalars) { std::copy_n(scalars + first, count, values.data() + first); }
    void give(double* scalars) const { std::copy_n(values.data() + first, count, scalars + first); }

    JointFront front;
    int first, count;
    Matrix6 slave, master;
    std::vector<double*> blocks;
    std::vector<double> values;
  };

  void project(const FoldMaps& maps);
  bool eliminate_in_space(const FoldMaps& maps, double* const* blocks);

  const PlaneOfMotion* plane_;
  int slave_, master_, variable_;
  int scalar_ = -1;  // of the one coordinate; -1: it is not unknown
  std::optional<InSpace> space_;
  // ---- of the last elimination
  Vector2 lever_left_ = Vector2::Zero(), lever_right_ = Vector2::Zero();
  Vector3 left_ = Vector3::Zero(), right_ = Vector3::Zero();
  double inverse_ = 0;
  Vector3 elimination_ = Vector3::Zero(), coupling_ = Vector3::Zero();
};

}  // namespace flexarm
