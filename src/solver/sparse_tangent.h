#pragma once
/// The tangent as a sparse matrix of the unknowns. Slaves are folded into their masters and released coordinates, block
/// by block, by a list of operations that is fixed when the model is built. KLU factorises the reduced matrix.

#include <optional>
#include <vector>

#include "solver/linear_solver.h"
#include "solver/tangent_backend.h"

namespace flexarm {

/// Block-sparse nodal tangent and its reduction to compressed columns.
///
/// Each pair of coupled variables has a dense column-major block. Folding slave s with released variable u and master m
/// first changes columns, (i,u) += (i,s) right and (i,m) += (i,s) L_right. Then it changes rows, (u,j) += left^T (s,j)
/// and (m,j) += L_left^T (s,j). Then it adds the geometric blocks. (docs/notes/joints.md 2)
///
/// When a force element couples other nodes, all of this is built again. A slider can couple any elements of its line,
/// but only few at a time. All of its blocks have permanent places, but the reduced matrix contains only those of the
/// sliders' active nodes. When a slider enters other elements, the pattern changes: pattern() returns a new number.
/// This class allocates no memory for that. But the solver repeats its analysis, which allocates and takes as long as
/// about three factorisations.
class SparseTangent : public TangentBackend {
 public:
  SparseTangent(const Model& model, const DegreesOfFreedom& dof);

  void set_zero() override;
  void add_closure(int closure, int index, double multiplier, const ClosureMaps& maps) override;
  /// If the nodes differ from those before, all blocks get new places, which allocates memory.
  void couple(int index, const int* nodes, int count) override;
  void add_coupling(int index, const Eigen::Ref<const Eigen::MatrixXd>& blocks) override;
  /// Adds the product as one dense matrix.
  void add_coupling(int index, const PieceTangent& tangent) override;
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
  /// The number of the present pattern. finish() may change the pattern.
  int pattern() const { return pattern_; }

 private:
  struct Block {
    int row, column;     // variables
    std::size_t offset;  // into values_
  };
  struct ColumnFold {
    int source, to_released, to_master, rows;
  };  // indices of blocks; -1: no block
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
  /// The same for the slave of a slider, whose masters are the line's nodes. The maps name the active ones. Members are
  /// indices into slide_blocks_, which has one entry per node of the line, or -1 for two nodes that are never active
  /// together.
  struct SlideOperation {
    int source, to_released, to_masters, size;
  };
  struct SlideFold {
    int first_column_fold = 0, last_column_fold = 0, first_row_fold = 0, last_row_fold = 0;
    int released_released = -1, released_masters = -1, masters_released = -1, masters_masters = -1;
  };
  /// Blocks of a closure; -1 if the parent is the world.
  struct ClosureBlocks {
    int parent_parent = -1, parent_child = -1, child_parent = -1, child_child = -1;
    int parent_multiplier = -1, child_multiplier = -1, multiplier_parent = -1, multiplier_child = -1;
  };
  struct ScaledAddition {
    int source, target, count;
  };
  struct MimicFold {
    int first_column_fold, first_row_fold, last_row_fold, master;  // indices into mimic_additions_; index of a block
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
  std::vector<int> element_places_, diagonal_places_;  // indices of blocks; see the pointers in TangentBackend
  std::vector<ColumnFold> column_folds_;
  std::vector<RowFold> row_folds_;
  std::vector<JointFold> joint_folds_;
  std::vector<SlideOperation> slide_columns_, slide_rows_;
  std::vector<SlideFold> slide_folds_;  // per joint
  std::vector<int> slide_blocks_;
  std::vector<ClosureBlocks> closure_blocks_;  // per closure
  /// The nodes of a force element, and the blocks of each node with each other one, row by row.
  struct Coupling {
    std::vector<int> nodes, blocks;
  };
  std::vector<Coupling> couplings_;
  std::vector<ScaledAddition> mimic_additions_;
  std::vector<MimicFold> mimic_folds_;
  std::vector<std::vector<int>> column_blocks_;  // per variable: blocks of the reduced matrix, sorted by rows
  std::vector<NodeRange> active_;                // per joint: of a slider, the nodes of its line in the pattern
  std::vector<char> live_;                       // per block: whether a tangent may write to it
  bool pattern_is_old_ = false;
  int pattern_ = 0;
  std::vector<double> values_, reduced_values_;
  std::vector<Copy> copies_;
  struct Span {
    std::size_t from, count;
  };
  std::vector<Span> written_;  // ranges of values_ to which a tangent may write
  std::vector<int> column_starts_, row_indices_;
  FoldMaps maps_;
  SlideMaps slide_maps_;
  std::optional<LinearSolver> solver_;  // created at the first factorisation
};

}  // namespace flexarm
