// SparseTangent: the blocks of the tangent, the list of operations that reduces it, and the pattern of the reduced
// matrix.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <unordered_map>

#include "solver/sparse_tangent.h"

namespace flexarm {

/// Creates blocks, and performs the folds symbolically.
class SparseTangent::PatternBuilder {
 public:
  PatternBuilder(SparseTangent& assembler)
      : a_(assembler), rows_of_(a_.dof_.size.size()), columns_of_(a_.dof_.size.size()), folded_(a_.dof_.size.size()) {}

  int block(int row, int column) {
    const std::uint64_t key = (static_cast<std::uint64_t>(row) << 32) | static_cast<std::uint32_t>(column);
    const auto [entry, is_new] = index_.try_emplace(key, static_cast<int>(a_.blocks_.size()));
    if (is_new) {
      a_.blocks_.push_back({row, column, offset_});
      offset_ += static_cast<std::size_t>(a_.dof_.size[row]) * a_.dof_.size[column];
      rows_of_[column].push_back(row);
      columns_of_[row].push_back(column);
    }
    return entry->second;
  }

  void add_closure(int k) {
    const int a = a_.model_.closures[k].parent, b = a_.model_.closures[k].child, u = a_.dof_.variable_of_closure(k);
    ClosureBlocks blocks;
    blocks.child_child = block(b, b), blocks.child_multiplier = block(b, u), blocks.multiplier_child = block(u, b);
    if (a >= 0) {
      blocks.parent_parent = block(a, a), blocks.parent_child = block(a, b), blocks.child_parent = block(b, a);
      blocks.parent_multiplier = block(a, u), blocks.multiplier_parent = block(u, a);
    }
    a_.closure_blocks_.push_back(blocks);
  }

  /// All nodes with each other; if the tangent consists of pieces alone, only those of each piece.
  void add_coupling(const ForcePieces& pieces, Coupling& coupling) {
    const std::vector<int>& nodes = coupling.nodes;
    const int count = static_cast<int>(nodes.size());
    coupling.blocks.assign(nodes.size() * nodes.size(), -1);
    const auto add = [&](int i, int j) {
      if (i >= 0 && j >= 0) coupling.blocks[i * count + j] = block(nodes[i], nodes[j]);
    };
    if (pieces.pairs.empty() || pieces.rank > 0) {
      for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) add(i, j);
      return;
    }
    for (const std::array<int, 2>& pair : pieces.pairs)
      for (const int i : pair)
        for (const int j : pair) add(i, j);
  }

  void fold_joint(int j) {
    const JointMap& joint = a_.model_.joints[j];
    const int s = a_.dof_.variable_of_node(joint.slave), m = joint.master;
    const int u = released_count(joint.kind) > 0 ? a_.dof_.variable_of_joint(j) : -1;
    JointFold fold;
    fold.first_column_fold = static_cast<int>(a_.column_folds_.size());
    const std::vector<int> rows = rows_of_[s];
    for (const int i : rows)
      if (!folded_[i])
        a_.column_folds_.push_back({block(i, s), u < 0 ? -1 : block(i, u), m < 0 ? -1 : block(i, m), a_.dof_.size[i]});
    fold.last_column_fold = static_cast<int>(a_.column_folds_.size());
    fold.first_row_fold = fold.last_row_fold = static_cast<int>(a_.row_folds_.size());
    const std::vector<int> columns = columns_of_[s];
    for (const int k : columns)
      if (!folded_[k] && k != s)
        a_.row_folds_.push_back({block(s, k), u < 0 ? -1 : block(u, k), m < 0 ? -1 : block(m, k), a_.dof_.size[k]});
    fold.last_row_fold = static_cast<int>(a_.row_folds_.size());
    fold.geometric = {u < 0 ? -1 : block(u, u), u < 0 || m < 0 ? -1 : block(u, m), u < 0 || m < 0 ? -1 : block(m, u),
                      m < 0 ? -1 : block(m, m)};
    folded_[s] = true;
    a_.joint_folds_[j] = fold;
  }

  void fold_slide(int j) {
    const JointMap& joint = a_.model_.joints[j];
    const SlideLine& line = a_.model_.slide_lines[joint.line];
    const int s = a_.dof_.variable_of_node(joint.slave), u = a_.dof_.variable_of_joint(j);
    std::vector<int> place(a_.dof_.size.size(), -1);  // per variable: index of the node in the line
    for (std::size_t k = 0; k < line.nodes.size(); ++k) place[line.nodes[k]] = static_cast<int>(k);
    const int count = static_cast<int>(line.nodes.size()), pieces = static_cast<int>(line.pieces.size());
    std::vector<int> partners_end(count);  // per node: it can be active together with all nodes before this index
    for (int p = 0; p < pieces; ++p) {
      const NodeRange active = line.support(p, std::min(p + SlideLine::kMostPieces, pieces) - 1);
      for (int k = active.first; k < active.end; ++k) partners_end[k] = std::max(partners_end[k], active.end);
    }
    // The blocks of `other` with all nodes of the line that can be active together with it.
    const auto blocks = [&](int other, bool other_is_row) {
      const int first = static_cast<int>(a_.slide_blocks_.size());
      for (int k = 0; k < count; ++k) {
        const int at = place[other];
        const bool together = at < 0 || std::max(at, k) < partners_end[std::min(at, k)];
        a_.slide_blocks_.push_back(!together      ? -1
                                   : other_is_row ? block(other, line.nodes[k])
                                                  : block(line.nodes[k], other));
      }
      return first;
    };
    SlideFold fold;
    fold.first_column_fold = static_cast<int>(a_.slide_columns_.size());
    const std::vector<int> rows = rows_of_[s];
    for (const int i : rows)
      if (!folded_[i]) a_.slide_columns_.push_back({block(i, s), block(i, u), blocks(i, true), a_.dof_.size[i]});
    fold.last_column_fold = static_cast<int>(a_.slide_columns_.size());
    fold.first_row_fold = static_cast<int>(a_.slide_rows_.size());
    const std::vector<int> columns = columns_of_[s];
    for (const int k : columns)
      if (!folded_[k] && k != s)
        a_.slide_rows_.push_back({block(s, k), block(u, k), blocks(k, false), a_.dof_.size[k]});
    fold.last_row_fold = static_cast<int>(a_.slide_rows_.size());
    fold.released_released = block(u, u);
    fold.released_masters = blocks(u, true);
    fold.masters_released = blocks(u, false);
    fold.masters_masters = static_cast<int>(a_.slide_blocks_.size());
    for (const int node : line.nodes) blocks(node, true);
    folded_[s] = true;
    a_.slide_folds_[j] = fold;
  }

  void fold_mimic(const DegreesOfFreedom::Mimic& mimic) {
    const int s = mimic.slave_variable, m = mimic.master_variable;
    MimicFold fold;
    fold.first_column_fold = static_cast<int>(a_.mimic_additions_.size());
    const std::vector<int> rows = rows_of_[s];
    for (const int i : rows)
      if (!folded_[i]) a_.mimic_additions_.push_back({block(i, s), block(i, m), a_.dof_.size[i]});
    fold.first_row_fold = static_cast<int>(a_.mimic_additions_.size());
    const std::vector<int> columns = columns_of_[s];
    for (const int k : columns)
      if (!folded_[k] && k != s) a_.mimic_additions_.push_back({block(s, k), block(m, k), a_.dof_.size[k]});
    fold.last_row_fold = static_cast<int>(a_.mimic_additions_.size());
    fold.master = block(m, m);
    a_.mimic_folds_.push_back(fold);
    folded_[s] = true;
  }

  std::size_t value_count() const { return offset_; }
  bool folded(int variable) const { return folded_[variable]; }

 private:
  SparseTangent& a_;
  std::size_t offset_ = 0;
  std::unordered_map<std::uint64_t, int> index_;
  std::vector<std::vector<int>> rows_of_, columns_of_;
  std::vector<bool> folded_;
};

SparseTangent::SparseTangent(const Model& model, const DegreesOfFreedom& dof)
    : model_(model), dof_(dof), slide_maps_(most_active_nodes(model.slide_lines)) {
  const std::vector<Vector6> at_rest(model.nodes.size(), Vector6::Zero());
  for (const auto& element : model.force_elements) {
    couplings_.emplace_back();
    find_nodes(*element, {model.nodes, at_rest}, couplings_.back().nodes);
  }
  build_pattern();
}

void SparseTangent::build_pattern_anew() {
  const int pattern = pattern_;
  const std::vector<NodeRange> active = active_;
  blocks_.clear(), element_places_.clear(), diagonal_places_.clear(), closure_blocks_.clear();
  column_folds_.clear(), row_folds_.clear(), slide_columns_.clear(), slide_rows_.clear(), slide_blocks_.clear();
  mimic_additions_.clear(), mimic_folds_.clear(), column_blocks_.clear();
  diagonal_blocks_.clear(), element_blocks_.clear();
  build_pattern();
  active_ = active;
  update_pattern();
  pattern_ = pattern + 1;
}

void SparseTangent::build_pattern() {
  joint_folds_.resize(model_.joints.size());
  slide_folds_.resize(model_.joints.size());
  column_blocks_.resize(dof_.size.size());
  active_.assign(model_.joints.size(), {0, 0});
  PatternBuilder pattern(*this);
  for (std::size_t v = 0; v < dof_.size.size(); ++v)
    diagonal_places_.push_back(pattern.block(static_cast<int>(v), static_cast<int>(v)));
  for_each_element(model_.beams, [&](const auto& element) {
    element_places_.resize(std::max<std::size_t>(element_places_.size(), element.first_block));
    for (const int i : element.nodes)
      for (const int j : element.nodes) element_places_.push_back(pattern.block(i, j));
  });
  for (std::size_t k = 0; k < model_.closures.size(); ++k) pattern.add_closure(static_cast<int>(k));
  for (std::size_t k = 0; k < couplings_.size(); ++k)
    pattern.add_coupling(model_.force_elements[k]->pieces(), couplings_[k]);
  for (int j = static_cast<int>(model_.joints.size()) - 1; j >= 0; --j) {
    if (model_.joints[j].kind == JointMapKind::Slide)
      pattern.fold_slide(j);
    else
      pattern.fold_joint(j);
  }
  for (const DegreesOfFreedom::Mimic& mimic : dof_.mimics) pattern.fold_mimic(mimic);
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (!pattern.folded(blocks_[b].row) && !pattern.folded(blocks_[b].column))
      column_blocks_[blocks_[b].column].push_back(static_cast<int>(b));
  for (std::vector<int>& list : column_blocks_)
    std::sort(list.begin(), list.end(), [&](int a, int b) { return blocks_[a].row < blocks_[b].row; });
  values_.assign(pattern.value_count(), 0.0);
  const auto place = [&](int block) { return values_.data() + blocks_[block].offset; };
  std::transform(diagonal_places_.begin(), diagonal_places_.end(), std::back_inserter(diagonal_blocks_), place);
  std::transform(element_places_.begin(), element_places_.end(), std::back_inserter(element_blocks_), place);
  written_.reserve(blocks_.size());
  live_.assign(blocks_.size(), true);
  build_compressed_columns();  // the largest possible pattern, so that the memory suffices for all later ones
  copies_.reserve(row_indices_.size());
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    if (model_.joints[j].kind != JointMapKind::Slide) continue;
    const SlideLine& line = model_.slide_lines[model_.joints[j].line];
    const int piece = line.piece_at(model_.initial_released[j].displacement[0]);
    active_[j] = line.support(piece, piece);
  }
  update_pattern();
  pattern_ = 0;
}

void SparseTangent::set_active(int j, int first, int count) {
  if (active_[j].first <= first && first + count <= active_[j].end) return;
  active_[j] = {first, first + count};
  pattern_is_old_ = true;
}

void SparseTangent::update_pattern() {
  mark_live_blocks();
  written_.clear();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (!live_[b]) continue;
    const Block& block = blocks_[b];
    const std::size_t count = static_cast<std::size_t>(dof_.size[block.row]) * dof_.size[block.column];
    if (!written_.empty() && written_.back().from + written_.back().count == block.offset)
      written_.back().count += count;
    else
      written_.push_back({block.offset, count});
  }
  build_compressed_columns();
  pattern_is_old_ = false;
  ++pattern_;
}

/// Repeats the folds symbolically, to find the blocks that are not always zero.
void SparseTangent::mark_live_blocks() {
  std::fill(live_.begin(), live_.end(), false);
  const auto mark = [&](int block) {
    if (block >= 0) live_[block] = true;
  };
  for (const int block : element_places_) mark(block);
  for (const int block : diagonal_places_) mark(block);
  for (const ClosureBlocks& b : closure_blocks_)
    for (const int block : {b.parent_parent, b.parent_child, b.child_parent, b.child_child, b.parent_multiplier,
                            b.child_multiplier, b.multiplier_parent, b.multiplier_child})
      mark(block);
  for (const Coupling& coupling : couplings_)
    for (const int block : coupling.blocks) mark(block);
  for (int j = static_cast<int>(model_.joints.size()) - 1; j >= 0; --j) {
    if (model_.joints[j].kind == JointMapKind::Slide) {
      mark_slide(j);
      continue;
    }
    const JointFold& fold = joint_folds_[j];
    const auto fold_operation = [&](const auto& op) {
      if (live_[op.source]) mark(op.to_released), mark(op.to_master);
    };
    for (int f = fold.first_column_fold; f < fold.last_column_fold; ++f) fold_operation(column_folds_[f]);
    for (int f = fold.first_row_fold; f < fold.last_row_fold; ++f) fold_operation(row_folds_[f]);
    const Geometric& g = fold.geometric;
    for (const int block : {g.released_released, g.released_master, g.master_released, g.master_master}) mark(block);
  }
  for (const MimicFold& fold : mimic_folds_) {
    for (int f = fold.first_column_fold; f < fold.last_row_fold; ++f)
      if (live_[mimic_additions_[f].source]) mark(mimic_additions_[f].target);
    mark(fold.master);
  }
}

void SparseTangent::mark_slide(int j) {
  const SlideFold& fold = slide_folds_[j];
  const NodeRange active = active_[j];
  const auto mark = [&](int first) {
    for (int k = active.first; k < active.end; ++k)
      if (slide_blocks_[first + k] >= 0) live_[slide_blocks_[first + k]] = true;
  };
  const auto fold_operation = [&](const SlideOperation& op) {
    if (!live_[op.source]) return;
    live_[op.to_released] = true;
    mark(op.to_masters);
  };
  for (int f = fold.first_column_fold; f < fold.last_column_fold; ++f) fold_operation(slide_columns_[f]);
  for (int f = fold.first_row_fold; f < fold.last_row_fold; ++f) fold_operation(slide_rows_[f]);
  const int count = static_cast<int>(model_.slide_lines[model_.joints[j].line].nodes.size());
  live_[fold.released_released] = true;
  mark(fold.released_masters);
  mark(fold.masters_released);
  for (int k = active.first; k < active.end; ++k) mark(fold.masters_masters + k * count);
}

void SparseTangent::build_compressed_columns() {
  column_starts_.assign(1, 0);
  row_indices_.clear();
  copies_.clear();
  for (std::size_t column = 0; column < dof_.size.size(); ++column) {
    for (int c = 0; c < dof_.size[column]; ++c) {
      if (dof_.equation[dof_.first[column] + c] < 0) continue;
      for (const int b : column_blocks_[column]) {
        if (!live_[b]) continue;
        const Block& block = blocks_[b];
        const int rows = dof_.size[block.row];
        for (int r = 0; r < rows; ++r) {
          const int equation = dof_.equation[dof_.first[block.row] + r];
          if (equation < 0) continue;
          const std::size_t from = block.offset + static_cast<std::size_t>(c) * rows + r;
          const int to = static_cast<int>(row_indices_.size());
          if (!copies_.empty() && copies_.back().from + copies_.back().count == from &&
              copies_.back().to + copies_.back().count == to)
            ++copies_.back().count;
          else
            copies_.push_back({from, to, 1});
          row_indices_.push_back(equation);
        }
      }
      column_starts_.push_back(static_cast<int>(row_indices_.size()));
    }
  }
  reduced_values_.assign(row_indices_.size(), 0.0);
}

}  // namespace flexarm
