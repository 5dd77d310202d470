// Closures of loops in the assembled system.
#include "solver/sparse_assembler.h"

namespace flexarm {

void SparseAssembler::add_closure(int closure, int index, double multiplier, const ClosureMaps& maps,
                                  bool with_tangent) {
  const LoopClosure& loop = model_.closures[closure];
  const int variable = dof_.variable_of_closure(closure), count = dof_.size[variable];
  residual(variable)[index] += maps.value;
  Eigen::Map<Vector6>(residual(loop.child)) += multiplier * maps.left.child;
  if (loop.parent >= 0) Eigen::Map<Vector6>(residual(loop.parent)) += multiplier * maps.left.parent;
  if (!with_tangent) return;
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

}  // namespace flexarm
