#pragma once
/// Block elimination of a mechanism's tangent along its tree, from the leaves to the root, in O(n).
/// (docs/notes/tree.md)

#include <vector>

#include "solver/bordered_elimination.h"
#include "solver/element_elimination.h"
#include "solver/interior_condensation.h"
#include "solver/joint_front.h"
#include "solver/tangent_backend.h"
#include "solver/tree_blocks.h"
#include "solver/tree_order.h"

namespace flexarm {

/// Solves with the tangent of a mechanism of beams and joints.
///
/// Each element is a dense front of its nodes. Eliminating all but the inboard node leaves a 6 x 6 Schur complement
/// there (ElementFront). A joint transfers the remainder of everything outboard from its slave to its master, and
/// eliminates its released coordinates (JointFront). This is the articulated-body algorithm with the tangent in place
/// of the inertia. The whole matrix is never formed, so that the cost of a chain of joints is proportional to its
/// length. Where sliders, loops or mimics couple more variables, the parts concerned are fronts with a border
/// (BorderedElimination).
class TreeTangent : public TangentBackend {
 public:
  /// Whether every node is connected to the root by exactly one chain of joints and elements. The chains may form
  /// loops.
  static bool suits(const Model& model, const DegreesOfFreedom& dof);

  /// The model must be one that suits(). Both arguments must outlive this object.
  TreeTangent(const Model& model, const DegreesOfFreedom& dof);

  void set_zero() override;
  void condense_interiors() override { condensation_ = std::make_unique<InteriorCondensation>(model_, order_); }
  InteriorCondensation* condensation() override { return condensation_.get(); }
  void add_closure(int closure, int index, double multiplier, const ClosureMaps& maps) override;
  void couple(int index, const int* nodes, int count) override { order_.set_coupling(index, nodes, count); }
  void add_coupling(int index, const Eigen::Ref<const Eigen::MatrixXd>& blocks) override;
  void add_coupling(int index, const PieceTangent& tangent) override;
  FoldMaps& fold_maps(int joint) override { return blocks_.maps[joint]; }
  SlideMaps& slide_maps(int joint) override { return blocks_.slide_maps[joint]; }
  void fold(int joint) override;
  void fold_mimics(const std::vector<MimicMap>& maps) override { blocks_.mimics = maps; }
  void finish() override {}
  void hold_row(int joint, int component, int first, const ReleasedVector& coefficients) override;
  bool factorise() override { return eliminate(nullptr); }
  bool factorise_and_solve(Eigen::VectorXd& b) override;
  int singular_variable() const override { return singular_variable_; }
  bool solve(Eigen::VectorXd& b) override;
  const double* expanded_solution() override { return values_.data(); }
  double cost_of_factors() const override;

 private:
  void hold_rows();
  void set_right_hand_side(const Eigen::VectorXd& b);
  bool eliminate(const Eigen::VectorXd* b);
  void condense(const TreePart& part, double* values);
  void forward(int part, const Eigen::VectorXd& b);
  bool substitute_back(Eigen::VectorXd& b);

  const Model& model_;
  TreeOrder order_;
  const DegreesOfFreedom& dof_;  // with auxiliary variables
  TreeBlocks blocks_;
  std::unique_ptr<InteriorCondensation> condensation_;  // null unless condense_interiors() was called
  ElementElimination<6> elements_;
  BorderedElimination bordered_;
  std::vector<JointFront> joints_;  // in the model's order
  int singular_variable_ = -1;
  std::vector<double> values_;  // per scalar: right-hand side, then solution
};

}  // namespace flexarm
