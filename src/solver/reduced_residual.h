#pragma once
/// Collects the residuals of nodes, coordinates and closures, and reduces them to those of the unknowns.

#include <vector>

#include "model/degrees_of_freedom.h"
#include "solver/tangent_backend.h"

namespace flexarm {

/// Residual per variable. Slaves are folded into their masters and released coordinates, from the leaves to the root;
/// then mimics are folded. Afterwards, the entry of a prescribed coordinate is the effort that drives it.
class ReducedResidual {
 public:
  ReducedResidual(const Model& model, const DegreesOfFreedom& dof);

  void set_zero();
  double* at(int variable) { return values_.data() + dof_.first[variable]; }
  const double* at(int variable) const { return values_.data() + dof_.first[variable]; }
  Eigen::Map<Vector6> node(int node) { return Eigen::Map<Vector6>(at(node)); }
  /// The residual of a slave is complete when its own slaves have been folded.
  Eigen::Map<const Vector6> node(int node) const { return Eigen::Map<const Vector6>(at(node)); }

  /// Adds constraint `index` of a closure with its multiplier. To be called before joints are folded.
  void add_closure(int closure, int index, double multiplier, const ClosureMaps& maps);
  /// Folds a joint's slave. `maps`: computed for the slave's total residual.
  void fold(int joint, const FoldMaps& maps);
  void fold(int joint, const SlideMaps& maps);
  /// Folds all mimics, and sets the geometric parts of `maps`.
  void fold_mimics(std::vector<MimicMap>& maps);
  /// Writes one entry per equation.
  void gather(Eigen::VectorXd& residual) const;

 private:
  const Model& model_;
  const DegreesOfFreedom& dof_;
  std::vector<double> values_;
};

}  // namespace flexarm
