#pragma once
/// Block elimination along the tree of a mechanism that moves in a plane: TreeTangent with three unknowns per node.
/// (docs/notes/planar.md)

#include <vector>

#include "model/plane.h"
#include "solver/element_elimination.h"
#include "solver/planar_joint_front.h"
#include "solver/tangent_backend.h"

namespace flexarm {

/// Right-hand sides and solutions have six entries per node, as in all backends; those out of the plane are zero.
/// Blocks of nodes and elements are PlanarBlock, in the plane's axes.
class PlanarTangent : public TangentBackend {
 public:
  /// Whether every node is connected to the root by exactly one chain of joints and elements, without further
  /// couplings.
  static bool suits(const Model& model, const DegreesOfFreedom& dof);

  /// The model must be one that suits(). All arguments must outlive this object.
  PlanarTangent(const Model& model, const DegreesOfFreedom& dof, const PlaneOfMotion& plane);

  void set_zero() override;
  void add_to_node(int node, const Matrix6& block) override;
  FoldMaps& fold_maps(int joint) override { return maps_[joint]; }
  void fold(int) override {}  // the elimination does this
  void finish() override {}
  void hold_row(int joint, int component, int first, const ReleasedVector& coefficients) override;
  bool factorise() override { return eliminate(false); }
  bool factorise_and_solve(Eigen::VectorXd& b) override;
  int singular_variable() const override { return singular_variable_; }
  bool solve(Eigen::VectorXd& b) override;
  const double* expanded_solution() override;
  double cost_of_factors() const override { return 2.2; }

  // ---- functions for mechanisms that do not suit
  /// @throws std::logic_error, as the following functions do: ignoring these terms silently would make steps wrong
  void add_closure(int closure, int index, double multiplier, const ClosureMaps& maps) override;
  void couple(int index, const int* nodes, int count) override;
  void add_coupling(int index, const Eigen::Ref<const Eigen::MatrixXd>& blocks) override;
  void add_coupling(int index, const PieceTangent& tangent) override;
  SlideMaps& slide_maps(int joint) override;
  /// Throws unless `maps` is empty.
  void fold_mimics(const std::vector<MimicMap>& maps) override;

 private:
  Eigen::Map<Vector3> node(int i) { return Eigen::Map<Vector3>(values_.data() + 4 * static_cast<std::size_t>(i)); }
  void set_right_hand_side(const Eigen::VectorXd& b);
  bool eliminate(bool with_right_hand_side);
  void forward(int part);
  bool substitute_back(Eigen::VectorXd& b);

  const DegreesOfFreedom& dof_;
  const PlaneOfMotion& plane_;
  TreeOrder order_;
  ElementElimination<3> fronts_;
  std::vector<FoldMaps> maps_;                          // per joint
  std::vector<PlanarJointFront> joints_;                // in the model's order
  std::vector<double> nodes_, elements_, coordinates_;  // blocks
  std::vector<double> values_, scalars_;                // right-hand side, then solution: four per node; one per scalar
  std::vector<double> expanded_;
  int singular_variable_ = -1;
};

}  // namespace flexarm
