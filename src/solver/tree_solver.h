#pragma once
/// Block elimination of a mechanism's tangent along its tree, from the leaves to the root, in O(n). (beyond.md 7)

#include <array>
#include <vector>

#include "joints/joint_map.h"
#include "model/degrees_of_freedom.h"

namespace flexarm {

/// Solves with the tangent of a mechanism whose beams and joints form a tree.
///
/// Every element is a dense front of its nodes; elimination of all but the inboard one leaves a 6 x 6 Schur complement
/// there (ElementFront). At a joint the slave carries what its whole outboard part has left, K; with the fold maps
/// N = [R L] of the released coordinates u and the master m
///   A = R_left^T K R_right + G_uu,  B = R_left^T K L_right + G_um,  C = L_left^T K R_right + G_mu,
///   K_m += L_left^T K L_right + G_mm - C A^-1 B:
/// the articulated-body algorithm with the tangent in the place of the inertia. No matrix of the whole is ever formed,
/// so a chain of joints costs no more than its length.
class TreeSolver {
 public:
  /// True if every node hangs on the root by one chain of joints and elements, and coordinates depend on no others.
  static bool suits(const Model& model, const DegreesOfFreedom& dof);

  /// Of a model that suits; both must outlive the solver.
  TreeSolver(const Model& model, const DegreesOfFreedom& dof);

  // ---- accumulation
  void set_zero();
  /// Column-major block on the diagonal of a variable (node or joint), size x size.
  double* diagonal_block(int variable) { return diagonals_.data() + 36 * static_cast<std::size_t>(variable); }
  /// Block (node i, node j) of an element, 6 x 6, column-major; `index` = element.first_block + i * Nodes + j.
  double* element_block(int index) { return elements_.data() + 36 * static_cast<std::size_t>(index); }
  /// Maps of a joint, to be set with tangent before factorise().
  FoldMaps& maps(int joint) { return joints_[joint].maps; }
  /// Replaces the row of a released component by `coefficients` in the columns of the components from `first` on.
  void hold_row(int joint, int component, int first, const ReleasedVector& coefficients);

  // ---- solution
  /// Replaces what was accumulated by its factors. False if a pivot is zero or not finite.
  bool factorise();
  /// Replaces b, one entry per equation, by the solution. False if that is not finite.
  bool solve(Eigen::VectorXd& b);

 private:
  /// A part of the tree: the joint of a slave, or an element with the nodes outboard of its first one.
  struct Part {
    int joint = -1;
    int node_count = 0;
    std::array<int, 5> nodes{};
    std::size_t first_block = 0, first_pivot = 0;
  };
  /// A joint's maps, then its factors. Components that are not unknown have zero columns and a unit pivot.
  struct JointFront {
    int slave = -1, master = -1, variable = -1;
    int count = 0;  // of unknown components
    std::array<int, 6> components{}, equations{};
    FoldMaps maps;
    Matrix6 left, right;                     // columns of the unknown components
    Matrix6 inverse, elimination, coupling;  // A^-1, A^-1 B, C
  };

  static std::vector<Part> parts_of(const Model& model, const DegreesOfFreedom& dof);
  template <int Size>
  bool eliminate_released(JointFront& front);
  void add_to_master(const JointFront& front, const Matrix6& tangent);
  bool eliminate(const Part& part);
  bool eliminate(JointFront& front);
  void forward(const Part& part);
  void forward(const JointFront& front, Eigen::VectorXd& b);
  void backward(const Part& part);
  void backward(const JointFront& front, Eigen::VectorXd& b);
  template <class Pointer, class Values>
  std::array<Pointer, 5> node_blocks(const Part& part, Values& values, int size) const;

  std::vector<Part> parts_;          // root to leaf
  std::vector<JointFront> joints_;   // in the model's order
  std::vector<int> first_equation_;  // per node; -1: slave
  std::vector<double> diagonals_, elements_, right_hand_sides_;
  std::vector<unsigned char> pivots_;
};

}  // namespace flexarm
