#pragma once
/// The tangent as a sparse matrix of the unknowns: slaves are folded into their masters and released coordinates, block
/// by block, along a program that is fixed when the model is built; KLU factorises what is left.

#include <optional>
#include <vector>

#include "solver/linear_solver.h"
#include "solver/tangent_backend.h"

namespace flexarm {

/// Block-sparse nodal tangent and its reduction to compressed columns.
///
/// Every pair of coupled variables has a dense column-major block. Folding slave s with released variable u and master
/// m: first the columns, (i,u) += (i,s) right and (i,m) += (i,s) L_right, then the rows, (u,j) += left^T (s,j) and
/// (m,j) += L_left^T (s,j), then the geometric blocks. (joints.md 2)
///
/// A force element that comes to couple other nodes has all of that made anew. A slider may come to couple any elements
/// of its line, but at a time it does few. All blocks have their places for good, and the reduced matrix only those
/// that the sliders' active nodes reach. When a slider enters other elements its pattern follows: a new number in
/// pattern(), no allocation here; but the solver analyses it anew, which allocates and takes the time of about three
/// factorisations.
class SparseTangent : public TangentBackend {
 public:
  SparseTangent(const Model& model, const DegreesOfFreedom& dof);

  void set_zero() override;
  void add_closure(int closure, int index, double multiplier, const ClosureMaps& maps) override;
  /// Other nodes than before: all blocks have other places then, which allocates.
  void couple(int index, const int* nodes, int count) override;
  void add_coupling(int index, const Eigen::Ref<const Eigen::MatrixXd>& blocks) override;
  FoldMaps& fold_maps(int) override { return maps_; }
  SlideMaps& slide_maps(int) override { return slide_maps_; }
  void fold(int joint) override;
  void fold(int joint, const FoldMaps& maps);
  void fold(int joint, const SlideMaps& maps);
  void fold_mimics(const std::vector<MimicMap>& maps) override;
  void finish() override;
  void hold_row(int joint, int component, int first, const ReleasedVector& coefficients) override;
  bool factorise() override;
  bool solve(Eigen::VectorXd& b) override;
  const double* expanded_solution() override { return nullptr; }
  const SparseTangent& matrix() const override { return *this; }
  double cost_of_factors() const override;

  // ---- reduced matrix, compressed columns
  int unknowns() const { return dof_.unknowns; }
  const std::vector<int>& column_starts() const { return column_starts_; }
  const std::vector<int>& row_indices() const { return row_indices_; }
  const std::vector<double>& values() const { return reduced_values_; }
  /// Changes with the pattern, in finish().
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
  void build_pattern_anew();
  void build_compressed_columns();
  void update_pattern();
  double* slide_block(int index) {
    const int block = slide_blocks_[index];
    return block < 0 ? nullptr : values_.data() + blocks_[block].offset;
  }

  const Model& model_;
  const DegreesOfFreedom& dof_;
  std::vector<Block> blocks_;
  std::vector<int> element_places_, diagonal_places_;  // blocks, as TangentBackend's pointers
  std::vector<ColumnFold> column_folds_;
  std::vector<RowFold> row_folds_;
  std::vector<JointFold> joint_folds_;
  std::vector<SlideOperation> slide_columns_, slide_rows_;
  std::vector<SlideFold> slide_folds_;  // per joint
  std::vector<int> slide_blocks_;
  std::vector<ClosureBlocks> closure_blocks_;  // per closure
  /// Of a force element: nodes, and blocks of each with each, by rows.
  struct Coupling {
    std::vector<int> nodes, blocks;
  };
  std::vector<Coupling> couplings_;
  std::vector<ScaledAddition> mimic_additions_;
  std::vector<MimicFold> mimic_folds_;
  std::vector<std::vector<int>> column_blocks_;  // per variable: blocks of the reduced matrix, by rows
  std::vector<NodeRange> active_;                // per joint that slides: nodes of its line that the pattern couples
  std::vector<char> live_;                       // per block: what a tangent may write
  bool pattern_is_old_ = false;
  int pattern_ = 0;
  std::vector<double> values_, reduced_values_;
  std::vector<Copy> copies_;
  struct Span {
    std::size_t from, count;
  };
  std::vector<Span> written_;  // of values_
  std::vector<int> column_starts_, row_indices_;
  FoldMaps maps_;
  SlideMaps slide_maps_;
  std::optional<LinearSolver> solver_;  // once something is to be solved
};

}  // namespace flexarm
