#pragma once
/// The tangent of a step, in the form that the elimination along the tree reads.

#include <vector>

#include "solver/tangent_backend.h"

namespace flexarm {

/// Blocks and maps before anything is folded.
struct TreeBlocks {
  /// A row of a released coordinate that is replaced by `coefficients` in the joint's components from `first` on.
  struct HeldRow {
    int joint, component, first;
    ReleasedVector coefficients;
  };

  TreeBlocks(const Model& model, const DegreesOfFreedom& dof);

  std::vector<double> diagonals, elements;  ///< 36 per variable and per block of two nodes
  std::vector<FoldMaps> maps;               ///< per joint
  std::vector<SlideMaps> slide_maps;        ///< per joint; empty but for sliders
  /// Per closure, by rows: {child, parent, multipliers} with each other.
  std::vector<Eigen::MatrixXd> closures;
  std::vector<Eigen::MatrixXd> couplings;  ///< per force element: of the nodes that it may couple at a time
  std::vector<MimicMap> mimics;
  std::vector<HeldRow> held;

  double* diagonal(int variable) { return diagonals.data() + 36 * static_cast<std::size_t>(variable); }
  const double* diagonal(int variable) const { return diagonals.data() + 36 * static_cast<std::size_t>(variable); }
  const double* element(std::size_t block) const { return elements.data() + 36 * block; }
};

/// Replaces the row of a released component in a joint's maps and in its `own` block, by columns, before the joint is
/// folded; see TangentBackend::hold_row.
void hold_row(FoldMaps& maps, double* own, bool has_master, int component, int first,
              const ReleasedVector& coefficients);

}  // namespace flexarm
