#pragma once
/// The tangent of a step, in the form that the elimination along the tree uses.

#include <vector>

#include "solver/tangent_backend.h"

namespace flexarm {

/// Blocks and maps before any fold.
struct TreeBlocks {
  /// The row of a released component that is replaced, see TangentBackend::hold_row.
  struct HeldRow {
    int joint, component, first;
    ReleasedVector coefficients;
  };

  TreeBlocks(const Model& model, const DegreesOfFreedom& dof);

  std::vector<double> diagonals, elements;  ///< 36 numbers per variable; 36 per pair of nodes of an element
  std::vector<FoldMaps> maps;               ///< per joint
  std::vector<SlideMaps> slide_maps;        ///< per joint; empty except for sliders
  /// Per closure: the matrix of {child, parent, multipliers}.
  std::vector<Eigen::MatrixXd> closures;
  std::vector<Eigen::MatrixXd> couplings;  ///< per force element: the matrix of the nodes that it couples
  /// The same for those in pieces, as in PieceTangent, but -left.
  struct Pieces {
    explicit Pieces(const ForcePieces& pieces)
        : numbers(PieceTangent::size(pieces)), tangent(PieceTangent::in(numbers.data(), pieces)) {
      tangent.set_zero();
    }
    Pieces(Pieces&&) = default;  // no copies: the tangent is in the numbers

    std::vector<double> numbers;
    PieceTangent tangent;
  };
  std::vector<Pieces> pieces;
  std::vector<MimicMap> mimics;
  std::vector<HeldRow> held;

  double* diagonal(int variable) { return diagonals.data() + 36 * static_cast<std::size_t>(variable); }
  const double* diagonal(int variable) const { return diagonals.data() + 36 * static_cast<std::size_t>(variable); }
  const double* element(std::size_t block) const { return elements.data() + 36 * block; }
};

/// Replaces the row of a released component in a joint's maps and in its column-major block `own`. To be called before
/// the joint is folded; see TangentBackend::hold_row.
void hold_row(FoldMaps& maps, double* own, bool has_master, int component, int first,
              const ReleasedVector& coefficients);

}  // namespace flexarm
