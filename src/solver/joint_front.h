#pragma once
/// Eliminates a joint's released coordinates: one front of the block elimination along a tree.

#include <array>

#include "joints/joint_map.h"
#include "model/degrees_of_freedom.h"

namespace flexarm {

/// Transfers K, the remainder of everything outboard at the slave, to the master. With the fold maps N = [R L] of the
/// released coordinates u and the master m, and the geometric blocks G of the maps:
///   A = R_left^T K R_right + G_uu,  B = R_left^T K L_right + G_um,  C = L_left^T K R_right + G_mu,
///   K_m += L_left^T K L_right + G_mm - C A^-1 B.
/// Components that are not unknowns have zero columns and a unit pivot.
class JointFront {
 public:
  /// For a joint of a tree that is not a slider; `variable`: that of the joint.
  JointFront(const JointMap& joint, int variable, const DegreesOfFreedom& dof);

  int variable() const { return variable_; }
  bool has_master() const { return master_ >= 0; }

  /// `blocks`: the diagonal blocks of all variables, column-major; the remainder is added to that of the master.
  /// Returns false if the pivot is zero or not finite.
  bool eliminate(const FoldMaps& maps, double* const* blocks);
  /// Forward elimination of a right-hand side with one value per scalar of the mechanism.
  void forward(const FoldMaps& maps, double* values) const;
  /// Back substitution.
  void backward(const FoldMaps& maps, double* values) const;

 private:
  template <int Size>
  bool eliminate_released(const FoldMaps& maps, double* const* blocks);

  int slave_, master_, variable_;
  int count_ = 0;  // number of unknown components
  std::array<int, 6> components_{}, scalars_{};
  Matrix6 left_, right_;                      // columns of the maps for the unknown components
  Matrix6 inverse_, elimination_, coupling_;  // A^-1, A^-1 B, C
};

}  // namespace flexarm
