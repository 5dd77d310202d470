#pragma once
/// Eliminates a joint's released coordinates in the plane: as JointFront, with {x, y, turn} for each node.

#include <algorithm>
#include <optional>
#include <vector>

#include "model/plane.h"
#include "solver/joint_front.h"

namespace flexarm {

/// A node's block in the plane; its columns are four numbers apart.
using PlanarBlock = Eigen::Map<Matrix3, 0, Eigen::OuterStride<4>>;
constexpr int kPlanarBlock = 12;

/// For joints with at most one coordinate, everything is projected to the plane. Joints with more coordinates use
/// JointFront in space. There, motions out of the plane get an arbitrary stiffness; their solution is zero.
class PlanarJointFront {
 public:
  PlanarJointFront(const JointMap& joint, int variable, const DegreesOfFreedom& dof, const PlaneOfMotion& plane);

  int variable() const { return variable_; }
  bool has_master() const { return master_ >= 0; }

  /// `blocks`: the diagonal blocks of all variables; those of nodes are PlanarBlock.
  bool eliminate(const FoldMaps& maps, double* const* blocks);
  /// Forward elimination of a right-hand side. `nodes`: four numbers per node; `scalars`: one value per scalar of the
  /// mechanism, of which only those of coordinates are used.
  void forward(const FoldMaps& maps, double* nodes, double* scalars);
  void backward(const FoldMaps& maps, double* nodes, double* scalars);

 private:
  /// Elimination in space: blocks and values in the form of JointFront.
  struct InSpace {
    InSpace(const JointMap& joint, int variable, const DegreesOfFreedom& dof);
    /// Copy the coordinates' values from and to the array of all scalars.
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
  int scalar_ = -1;  // of the only coordinate; -1: it is not an unknown
  std::optional<InSpace> space_;
  // ---- of the last elimination
  Vector2 lever_left_ = Vector2::Zero(), lever_right_ = Vector2::Zero();
  Vector3 left_ = Vector3::Zero(), right_ = Vector3::Zero();
  double inverse_ = 0;
  Vector3 elimination_ = Vector3::Zero(), coupling_ = Vector3::Zero();
};

}  // namespace flexarm
