#pragma once
/// From nodal residuals and tangents to the reduced system of the unknowns: slaves are folded into their masters and
/// released coordinates, block by block, along a program that is fixed when the model is built.

#include <vector>

#include "joints/closure_maps.h"
#include "joints/joint_map.h"
#include "joints/slide_map.h"
#include "model/degrees_of_freedom.h"
#include "solver/tree_solver.h"

namespace flexarm {

/// Of a coordinate that follows another one: the factors of its row and of its column, and the derivative of the
/// former.
struct MimicMap {
  double left, right, left_derivative;
};

/// Block-sparse nodal tangent and its reduction to compressed columns.
///
/// Every pair of coupled variables has a dense column-major block. Folding slave s with released variable u and master
/// m: first the columns, (i,u) += (i,s) right and (i,m) += (i,s) L_right, then the rows, (u,j) += left^T (s,j) and
/// (m,j) += L_left^T (s,j), then the geometric blocks. (joints.md 2)
///
/// A slider may come to couple any elements of its line, but at a time it does few. All blocks have their places for
/// good, and the reduced matrix only those that the sliders' active nodes reach. When a slider enters other elements
/// its pattern follows: a new number in pattern(), no allocation here; but the solver analyses it anew, which allocates
/// and takes the time of about three factorisations.
class SparseAssembler {
 public:
  /// With a `tree` the blocks of the tangent are the tree's, and there is no matrix: folding is left to its
  /// elimination.
  SparseAssembler(const Model& model, const DegreesOfFreedom& dof, TreeSolver* tree = nullptr);

  // ---- accumulation
  void set_zero(bool with_tangent = true);
  double* residual(int variable) { return residual_.data() + dof_.first[variable]; }
  const double* residual(int variable) const { return residual_.data() + dof_.first[variable]; }
  /// Column-major block on the diagonal of a variable, size x size.
  double* diagonal_block(int variable) {
    if (tree_) return tree_->diagonal_block(variable);
    return values_.data() + blocks_[diagonal_[variable]].offset;
  }
  /// Block (node i, node j) of an element, 6 x 6; `index` = element.first_block + i * Nodes + j.
  double* element_block(int index) {
    if (tree_) return tree_->element_block(index);
    return values_.data() + blocks_[element_blocks_[index]].offset;
  }

  /// Adds constraint `index` of a closure with its multiplier, before joints are folded.
  void add_closure(int closure, int index, double multiplier, const ClosureMaps& maps, bool with_tangent);

  // ---- reduction
  /// Total residual of a slave node, complete once its own slaves have been folded.
  Eigen::Map<const Vector6> slave_residual(int node) const { return Eigen::Map<const Vector6>(residual(node)); }
  /// Folds the slave of `joint`; to be called leaf to root, with the maps for the slave's total residual.
  void fold(int joint, const FoldMaps& maps, bool with_tangent);
  void fold(int joint, const SlideMaps& maps, bool with_tangent);
  /// Folds coordinates that follow others; after all joints. `maps`: per entry of DegreesOfFreedom::mimics.
  void fold_mimics(const std::vector<MimicMap>& maps, bool with_tangent);
  /// Writes the reduced residual and, if asked, the compressed-column values.
  void gather(Eigen::VectorXd& residual) const;
  void gather_tangent();
  /// Replaces the gathered row of an equation by `coefficients` in the columns from `first` on, and zeros.
  void set_row(int equation, int first, const ReleasedVector& coefficients);

  // ---- reduced matrix, compressed columns
  int unknowns() const { return dof_.unknowns; }
  const std::vector<int>& column_starts() const { return column_starts_; }
  const std::vector<int>& row_indices() const { return row_indices_; }
  const std::vector<double>& values() const { return reduced_values_; }
  /// Changes with the pattern, in gather_tangent().
  int pattern() const { return pattern_; }

 private:
  struct Block {
    int row, column;     // variables
    std::size_t offset;  // into values_
  };
  struct ColumnFold {
    int source, to_released, to_master, rows;
  };  // block indices; -1: none
  struct RowFold {
    int source, to_released, to_master, columns;
  };
  struct Geometric {
    int released_released, released_master, master_released, master_master;
  };
  struct JointFold {
    int first_column_fold, last_column_fold, first_row_fold, last_row_fold;
    Geometric geometric;
  };
  /// The like for a slave of many masters: the line's nodes, of which the maps name the active ones. Indices into
  /// slide_blocks_, one entry per node of the line; -1 where two nodes are never active together.
  struct SlideOperation {
    int source, to_released, to_masters, size;
  };
  struct SlideFold {
    int first_column_fold = 0, last_column_fold = 0, first_row_fold = 0, last_row_fold = 0;
    int released_released = -1, released_masters = -1, masters_released = -1, masters_masters = -1;
  };
  /// Blocks of a closure; -1 where the parent is the world.
  struct ClosureBlocks {
    int parent_parent = -1, parent_child = -1, child_parent = -1, child_child = -1;
    int parent_multiplier = -1, child_multiplier = -1, multiplier_parent = -1, multiplier_child = -1;
  };
  struct ScaledAddition {
    int source, target, count;
  };
  struct MimicFold {
    int first_column_fold, first_row_fold, last_row_fold, master;  // into mimic_folds_; block
  };
  struct Copy {
    std::size_t from;
    int to, count;
  };

  class PatternBuilder;
  void fold_columns(const JointFold& fold, const FoldMaps& maps);
  void fold_rows(const JointFold& fold, const FoldMaps& maps);
  void add_geometric(const Geometric& geometric, const FoldMaps& maps);
  void fold_slide_columns(const SlideFold& fold, const SlideMaps& maps);
  void fold_slide_rows(const SlideFold& fold, const SlideMaps& maps);
  void set_active(int joint, int first, int count);
  void mark_live_blocks();
  void mark_slide(int joint);
  void build_pattern();
  void build_compressed_columns();
  void update_pattern();
  double* slide_block(int index) {
    const int block = slide_blocks_[index];
    return block < 0 ? nullptr : values_.data() + blocks_[block].offset;
  }

  const Model& model_;
  const DegreesOfFreedom& dof_;
  TreeSolver* tree_;
  std::vector<Block> blocks_;
  std::vector<int> element_blocks_, diagonal_;
  std::vector<ColumnFold> column_folds_;
  std::vector<RowFold> row_folds_;
  std::vector<JointFold> joint_folds_;
  std::vector<SlideOperation> slide_columns_, slide_rows_;
  std::vector<SlideFold> slide_folds_;  // per joint
  std::vector<int> slide_blocks_;
  std::vector<ClosureBlocks> closure_blocks_;  // per closure
  std::vector<ScaledAddition> mimic_additions_;
  std::vector<MimicFold> mimic_folds_;
  std::vector<std::vector<int>> column_blocks_;  // per variable: blocks of the reduced matrix, by rows
  std::vector<NodeRange> active_;                // per joint that slides: nodes of its line that the pattern couples
  std::vector<char> live_;                       // per block: what a tangent may write
  bool pattern_is_old_ = false;
  int pattern_ = 0;
  std::vector<double> values_, residual_, reduced_values_;
  std::vector<Copy> copies_;
  struct Span {
    std::size_t from, count;
  };
  std::vector<Span> written_;  // of values_
  std::vector<int> column_starts_, row_indices_;
};

}  // namespace flexarm
