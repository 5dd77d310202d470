#include "solver/sparse_tangent.h"

#include <algorithm>
#include <cassert>

namespace flexarm {
namespace {

template <int Rows>
using Columns6 = Eigen::Map<Eigen::Matrix<double, Rows, 6>>;

/// (i,u) += (i,s) right, (i,m) += (i,s) L_right for a block row of `Rows` scalars.
template <int Rows>
void fold_block_columns(const double* source, int rows, const FoldMaps& maps, double* to_released, double* to_master) {
  using Block = Eigen::Matrix<double, Rows, 6, Eigen::ColMajor, Rows == Eigen::Dynamic ? 6 : Rows, 6>;
  using BlockMap = Eigen::Map<const Block>;
  const BlockMap from(source, rows, 6);
  if (to_released) {
    using Released = Eigen::Matrix<double, Rows, Eigen::Dynamic, Eigen::ColMajor, Rows == Eigen::Dynamic ? 6 : Rows, 6>;
    Eigen::Map<Released>(to_released, rows, maps.right.cols()) += from.lazyProduct(maps.right);
  }
  if (to_master) {
    Eigen::Map<Block> to(to_master, rows, 6);
    to += from;
    // dr_s = dr_m + spin x lever: the spin columns get -(i,s)_r lever^.
    const Vector3& l = maps.lever_right;
    to.col(3) += from.col(2) * l.y() - from.col(1) * l.z();
    to.col(4) += from.col(0) * l.z() - from.col(2) * l.x();
    to.col(5) += from.col(1) * l.x() - from.col(0) * l.y();
  }
}

}  // namespace

void SparseTangent::set_zero() {
  for (const Span& span : written_) std::fill_n(values_.begin() + span.from, span.count, 0.0);
}

void SparseTangent::add_closure(int closure, int index, double multiplier, const ClosureMaps& maps) {
  assert(index >= 0 && index < dof_.size[dof_.variable_of_closure(closure)]);
  const LoopClosure& loop = model_.closures[closure];
  const int count = dof_.size[dof_.variable_of_closure(closure)];
  const ClosureBlocks& blocks = closure_blocks_[closure];
  const auto at = [&](int block) { return values_.data() + blocks_[block].offset; };
  const auto add = [&](int block, const Matrix6& values) { Eigen::Map<Matrix6>(at(block)) += multiplier * values; };
  const auto add_column = [&](int block, const Vector6& left) { Eigen::Map<Vector6>(at(block) + 6 * index) += left; };
  const auto add_row = [&](int block, const Vector6& right) {
    for (int k = 0; k < 6; ++k) at(block)[k * count + index] += right[k];
  };
  add(blocks.child_child, maps.child_child);
  add_column(blocks.child_multiplier, maps.left.child);
  add_row(blocks.multiplier_child, maps.right.child);
  if (loop.parent < 0) return;
  add(blocks.parent_parent, maps.parent_parent);
  add(blocks.parent_child, maps.parent_child);
  add(blocks.child_parent, maps.child_parent);
  add_column(blocks.parent_multiplier, maps.left.parent);
  add_row(blocks.multiplier_parent, maps.right.parent);
}

void SparseTangent::couple(int index, const int* nodes, int count) {
  assert(index >= 0 && static_cast<std::size_t>(index) < couplings_.size() && count >= 0);
  std::vector<int>& old = couplings_[index].nodes;
  if (std::equal(nodes, nodes + count, old.begin(), old.end())) return;
  old.assign(nodes, nodes + count);
  build_pattern_anew();
}

void SparseTangent::add_coupling(int index, const Eigen::Ref<const Eigen::MatrixXd>& values) {
  const auto& [nodes, blocks] = couplings_[index];
  assert(values.cols() == values.rows() && values.rows() == 6 * static_cast<Eigen::Index>(nodes.size()));
  const int count = static_cast<int>(nodes.size());
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const auto value = values.block<6, 6>(6 * i, 6 * j);
      const int block = blocks[i * count + j];
      assert(block >= 0 || value.isZero(0));  // nodes that are in no piece together have no block
      if (block >= 0) Eigen::Map<Matrix6>(values_.data() + blocks_[block].offset) += value;
    }
}

void SparseTangent::add_coupling(int index, const PieceTangent& tangent) {
  const auto& [nodes, blocks] = couplings_[index];
  const int count = static_cast<int>(nodes.size());
  const auto block = [&, places = blocks.data()](int i, int j) {
    return Eigen::Map<Matrix6>(values_.data() + blocks_[places[i * count + j]].offset);
  };
  const ForcePieces& pieces = model_.force_elements[index]->pieces();
  if (pieces.rank > 0) return add_coupling(index, tangent.sum(pieces, nodes.size()));
  for (std::size_t p = 0; p < pieces.pairs.size(); ++p)
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        if (pieces.pairs[p][i] >= 0 && pieces.pairs[p][j] >= 0)
          block(pieces.pairs[p][i], pieces.pairs[p][j]) +=
              tangent.blocks.block<6, 6>(6 * i, static_cast<Eigen::Index>(12 * p) + 6 * j);
}

void SparseTangent::fold(int j) {
  if (model_.joints[j].kind == JointMapKind::Slide)
    fold(j, slide_maps_);
  else
    fold(j, maps_);
}

void SparseTangent::fold(int j, const FoldMaps& maps) {
  const JointFold& fold = joint_folds_[j];
  fold_columns(fold, maps);
  fold_rows(fold, maps);
  add_geometric(fold.geometric, maps);
}

void SparseTangent::fold(int j, const SlideMaps& maps) {
  const SlideLine& line = model_.slide_lines[model_.joints[j].line];
  set_active(j, maps.first, maps.count);
  const SlideFold& fold = slide_folds_[j];
  fold_slide_columns(fold, maps);
  fold_slide_rows(fold, maps);
  const int count = static_cast<int>(line.nodes.size());
  values_[blocks_[fold.released_released].offset] += maps.released_released;
  for (int i = 0; i < maps.count; ++i) {
    const int node = maps.first + i;
    Eigen::Map<Vector6>(slide_block(fold.released_masters + node)) += maps.released_master[i];
    Eigen::Map<Vector6>(slide_block(fold.masters_released + node)) += maps.master_released[i];
    for (int k = 0; k < maps.count; ++k)
      Eigen::Map<Matrix6>(slide_block(fold.masters_masters + node * count + maps.first + k)).bottomRows<3>() +=
          maps.moment_master[i * maps.count + k];
  }
}

void SparseTangent::fold_slide_columns(const SlideFold& fold, const SlideMaps& maps) {
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, 6, 6>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;
  for (int f = fold.first_column_fold; f < fold.last_column_fold; ++f) {
    const SlideOperation& op = slide_columns_[f];
    const Columns from = Eigen::Map<const Columns>(values_.data() + blocks_[op.source].offset, op.size, 6);
    if (from.isZero(0)) continue;
    Eigen::Map<Column>(values_.data() + blocks_[op.to_released].offset, op.size) +=
        from.lazyProduct(maps.released_right);
    for (int k = 0; k < maps.count; ++k)
      if (double* to = slide_block(op.to_masters + maps.first + k))
        Eigen::Map<Columns>(to, op.size, 6) += from.lazyProduct(maps.right[k]);
  }
}

void SparseTangent::fold_slide_rows(const SlideFold& fold, const SlideMaps& maps) {
  using Rows = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
  using Row = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, 6>;
  for (int f = fold.first_row_fold; f < fold.last_row_fold; ++f) {
    const SlideOperation& op = slide_rows_[f];
    const Rows from = Eigen::Map<const Rows>(values_.data() + blocks_[op.source].offset, 6, op.size);
    if (from.isZero(0)) continue;  // for example a node of the line that is not active
    Eigen::Map<Row>(values_.data() + blocks_[op.to_released].offset, op.size) +=
        maps.released_left.transpose().lazyProduct(from);
    for (int k = 0; k < maps.count; ++k)
      if (double* to = slide_block(op.to_masters + maps.first + k))
        Eigen::Map<Rows>(to, 6, op.size) += maps.left[k].transpose().lazyProduct(from);
  }
}

void SparseTangent::fold_columns(const JointFold& fold, const FoldMaps& maps) {
  for (int f = fold.first_column_fold; f < fold.last_column_fold; ++f) {
    const ColumnFold& op = column_folds_[f];
    const double* source = values_.data() + blocks_[op.source].offset;
    double* to_released = op.to_released < 0 ? nullptr : values_.data() + blocks_[op.to_released].offset;
    double* to_master = op.to_master < 0 ? nullptr : values_.data() + blocks_[op.to_master].offset;
    if (op.rows == 6)
      fold_block_columns<6>(source, 6, maps, to_released, to_master);
    else
      fold_block_columns<Eigen::Dynamic>(source, op.rows, maps, to_released, to_master);
  }
}

void SparseTangent::fold_rows(const JointFold& fold, const FoldMaps& maps) {
  using Rows = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
  for (int f = fold.first_row_fold; f < fold.last_row_fold; ++f) {
    const RowFold& op = row_folds_[f];
    const Eigen::Map<const Rows> from(values_.data() + blocks_[op.source].offset, 6, op.columns);
    if (op.to_released >= 0) {
      Eigen::Map<ReleasedSquare> to(values_.data() + blocks_[op.to_released].offset, maps.left.cols(), op.columns);
      to += maps.left.transpose().lazyProduct(from);
    }
    if (op.to_master >= 0) {
      Eigen::Map<Rows> to(values_.data() + blocks_[op.to_master].offset, 6, op.columns);
      to += from;
      const Vector3& l = maps.lever_left;  // moment row: lever x f
      to.row(3) += l.y() * from.row(2) - l.z() * from.row(1);
      to.row(4) += l.z() * from.row(0) - l.x() * from.row(2);
      to.row(5) += l.x() * from.row(1) - l.y() * from.row(0);
    }
  }
}

void SparseTangent::add_geometric(const Geometric& geometric, const FoldMaps& maps) {
  const int count = static_cast<int>(maps.left.cols());
  const auto add = [&](int block, int rows, int columns, const auto& corner) {  // to the last rows and columns
    if (block < 0) return;
    Eigen::Map<Eigen::MatrixXd> to(values_.data() + blocks_[block].offset, rows, columns);
    to.bottomRightCorner(corner.rows(), corner.cols()) += corner;
  };
  if (count > 0) {
    add(geometric.released_released, count, count, maps.released_released);
    add(geometric.released_master, count, 6, maps.released_spin);
    add(geometric.master_released, 6, count, maps.moment_released);
  }
  add(geometric.master_master, 6, 6, maps.moment_spin);
}

void SparseTangent::fold_mimics(const std::vector<MimicMap>& maps) {
  assert(maps.size() == dof_.mimics.size());
  const auto add = [&](int first, int last, double factor) {
    for (int f = first; f < last; ++f) {
      const ScaledAddition& op = mimic_additions_[f];
      for (int k = 0; k < op.count; ++k)
        values_[blocks_[op.target].offset + k] += factor * values_[blocks_[op.source].offset + k];
    }
  };
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const MimicFold& fold = mimic_folds_[i];
    add(fold.first_column_fold, fold.first_row_fold, maps[i].right);
    add(fold.first_row_fold, fold.last_row_fold, maps[i].left);
    values_[blocks_[fold.master].offset] += maps[i].geometric;
  }
}

void SparseTangent::finish() {
  if (pattern_is_old_) update_pattern();
  for (const Copy& copy : copies_)
    std::copy_n(values_.data() + copy.from, copy.count, reduced_values_.data() + copy.to);
}

void SparseTangent::hold_row(int joint, int component, int first, const ReleasedVector& coefficients) {
  const int equation = dof_.equation[dof_.first[dof_.variable_of_joint(joint)] + component];
  const int first_column = equation - component + first;
  for (int column = 0; column < unknowns(); ++column) {
    const auto end = row_indices_.begin() + column_starts_[column + 1];
    const auto entry = std::lower_bound(row_indices_.begin() + column_starts_[column], end, equation);
    if (entry == end || *entry != equation) continue;
    const int k = column - first_column;
    reduced_values_[entry - row_indices_.begin()] = k >= 0 && k < coefficients.size() ? coefficients[k] : 0.0;
  }
}

bool SparseTangent::factorise() {
  if (!solver_) solver_.emplace(unknowns(), column_starts_, row_indices_);
  return solver_->factorise(reduced_values_, pattern_);
}

bool SparseTangent::solve(Eigen::VectorXd& b) {
  assert(solver_ && "after factorise()");
  return solver_->solve(b);
}

double SparseTangent::cost_of_factors() const {
  return 5;  // measured: bench_kernels --benchmark_filter=step_shares, counter "new/kept"
}

}  // namespace flexarm
