#pragma once
/// Block elimination of a mechanism's tangent along its tree, from the leaves to the root, in O(n). (beyond.md 7)

#include <array>
#include <vector>

#include "solver/tangent_backend.h"

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
class TreeTangent : public TangentBackend {
 public:
  /// True if every node hangs on the root by one chain of joints and elements, and coordinates depend on no others.
  static bool suits(const Model& model, const DegreesOfFreedom& dof);

  /// Of a model that suits; both must outlive the solver.
  TreeTangent(const Model& model, const DegreesOfFreedom& dof);

  void set_zero() override;
  void add_closure(int, int, double, const ClosureMaps&) override {}  // there are none, see suits()
  FoldMaps& fold_maps(int joint) override { return joints_[joint].maps; }
  void fold(int) override {}  // is left to the elimination
  void fold(int, const SlideMaps&) override {}
  void fold_mimics(const std::vector<MimicMap>&) override {}
  void finish() override {}
  void hold_row(int joint, int component, int first, const ReleasedVector& coefficients) override;
  bool factorise() override;
  bool solve(Eigen::VectorXd& b) override;
  double cost_of_factors() const override;

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
