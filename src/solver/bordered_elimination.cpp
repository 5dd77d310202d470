#include "solver/bordered_elimination.h"

#include <algorithm>

namespace flexarm {

BorderedElimination::BorderedElimination(const Model& model, const DegreesOfFreedom& dof, const TreeOrder& order,
                                         TreeBlocks& blocks)
    : model_(model),
      dof_(dof),
      order_(order),
      blocks_(blocks),
      front_(dof.scalar_count),
      is_placed_(dof.scalar_count, false),
      factors_(order.parts().size()) {
  std::fill_n(is_placed_.begin(), 6 * dof.node_count, true);
  for (int scalar = 0; scalar < dof.scalar_count; ++scalar)
    if (dof.equation[scalar] >= 0) is_placed_[scalar] = true;
  for (const DegreesOfFreedom::Mimic& mimic : dof.mimics) is_placed_[dof.first[mimic.slave_variable]] = true;
  for (std::size_t k = 0; k < model.force_elements.size(); ++k)
    for (int g = 0; g < order.auxiliary_count(static_cast<int>(k)); ++g) {
      const int auxiliary = order.auxiliary(static_cast<int>(k), g);
      std::fill_n(is_placed_.begin() + dof.first[auxiliary], dof.size[auxiliary], true);
    }
  reserve();
}

/// Reserves memory that suffices for any windows of sliders. More is allocated only if pivots are postponed repeatedly.
/// Memory for couplings that may occur but do not, such as those of distant beams, is reserved but not touched, so that
/// the system does not provide it.
void BorderedElimination::reserve() {
  std::size_t scalars = 0, fours = 0;
  int most = 0;
  for (std::size_t p = 0; p < factors_.size(); ++p) {
    const int riders = order_.most_riders(static_cast<int>(p));
    const TreePart& part = order_.parts()[p];
    if (riders == 0 && !part.has_border) continue;
    int own = 12;  // a slave and a master, or an inboard node
    for (const int variable : part.complete) own += dof_.size[variable];
    for (const int e : part.elements) own += 6 * order_.parts()[e].node_count;
    own += 6 * static_cast<int>(part.closures.size()) + static_cast<int>(part.mimics.size());
    own += 6 * static_cast<int>(part.pieces.size());
    for (const auto& factor : part.factors) own += dof_.size[order_.auxiliary(factor.coupling, factor.group)];
    for (const auto& [coupling, row, column] : part.inners) own += 2 * dof_.size[order_.auxiliary(coupling, row)];
    const int size = own + riders, lanes = lanes_for(size);
    most = std::max(most, size);
    scalars += 4 * static_cast<std::size_t>(size);
    fours += static_cast<std::size_t>(lanes) * (3 * own + 16 + 2 * riders);
  }
  scalars_.reserve(scalars);
  memory_.reserve(fours);
  runs_.reserve(most);
  certain_.reserve(factors_.size());
  work_.resize(lanes_for(most));
  front_.reserve(most);
}

void BorderedElimination::begin() {
  scalars_.clear();
  used_ = 0;
}

std::size_t BorderedElimination::allocate(int numbers) {
  const std::size_t at = used_;
  used_ += lanes_for(numbers);
  if (used_ > memory_.size()) memory_.resize(used_ <= memory_.capacity() ? used_ : 2 * used_);
  return at;
}

bool BorderedElimination::eliminate(int index) {
  const TreePart& part = order_.parts()[index];
  Factors& factors = factors_[index] = {};
  if (part.front != index) return true;  // it is eliminated later, in the front of another part
  lay_out(index);
  assemble(index);
  for_each_member(index, [&](const TreePart& member) {
    if (member.joint >= 0) fold_slave(member, factors);
  });
  fold_mimics(part, factors);
  hold_rows(index, factors);
  const int pivots = front_.eliminate(candidates_, certain_, part.passes_node);
  if (pivots < 0) return false;
  keep(pivots, factors);
  pass_on(part, factors);
  return true;
}

// ---------------------------------------------------------------- the front of a part

void BorderedElimination::add_scalars(int variable) {
  for (int k = 0; k < dof_.size[variable]; ++k) {
    const int scalar = dof_.first[variable] + k;
    if (!is_placed_[scalar]) continue;
    front_.rows.push_back(scalar);
    front_.columns.push_back(scalar);
  }
}

template <class Visit>
void BorderedElimination::for_each_member(int index, const Visit& visit) const {
  const std::vector<TreePart>& parts = order_.parts();
  for (int p = parts[index].first_member; p >= 0; p = parts[p].next_member) visit(parts[p]);
}

bool BorderedElimination::is_folded(const TreePart& part, int variable) const {
  if (variable < dof_.node_count) return dof_.slave_joint[variable] >= 0;
  return std::any_of(part.mimics.begin(), part.mimics.end(),
                     [&](int i) { return dof_.mimics[i].slave_variable == variable; });
}

/// Sets the rows and columns of the front, in this order: complete nodes; postponed pivots of earlier parts; complete
/// coordinates and multipliers; riders, which later parts eliminate; variables that are folded.
void BorderedElimination::lay_out(int index) {
  const TreePart& part = order_.parts()[index];
  front_.clear();
  certain_.clear();
  for_each_member(index, [&](const TreePart& member) {
    for (const int variable : member.complete)
      if (variable < dof_.node_count && !is_folded(member, variable)) add_scalars(variable);
    certain_.push_back(front_.size());
  });
  for_each_member(index, [&](const TreePart& member) {
    for (int child = member.first_child; child >= 0; child = order_.parts()[child].next_sibling) {
      const Factors& f = factors_[child];  // empty if the child is a member of this front
      const auto rows = scalars_.begin() + f.rows + f.pivots, columns = scalars_.begin() + f.columns + f.pivots;
      front_.rows.insert(front_.rows.end(), rows, rows + f.delayed);
      front_.columns.insert(front_.columns.end(), columns, columns + f.delayed);
    }
  });
  for_each_member(index, [&](const TreePart& member) {
    for (const int variable : member.complete)
      if (variable >= dof_.node_count && !is_folded(member, variable)) add_scalars(variable);
  });
  candidates_ = front_.size();
  const int* border = order_.border(part);
  for (int i = 0; i < part.border_count; ++i)
    if (order_.completion(border[i]) > index) add_scalars(border[i]);
  const int active = front_.size();
  for_each_member(index, [&](const TreePart& member) {
    for (const int variable : member.complete)
      if (is_folded(member, variable)) add_scalars(variable);
  });
  front_.start(active);
}

void BorderedElimination::assemble(int index) {
  for_each_member(index, [&](const TreePart& part) {
    for (int child = part.first_child; child >= 0; child = order_.parts()[child].next_sibling)
      if (order_.parts()[child].front == child) add_remainder(factors_[child]);
    for (const int e : part.elements) {
      const TreePart& element = order_.parts()[e];
      for (int i = 0; i < element.node_count; ++i)
        for (int j = 0; j < element.node_count; ++j)
          front_.add(6 * element.nodes[i], 6 * element.nodes[j],
                     blocks_.element(element.first_block + i * element.node_count + j), 6, 6, 6);
    }
    for (const int closure : part.closures) add_closure(closure);
    for (int k = part.first_coupling; k >= 0; k = order_.next_coupling(k)) add_coupling(k);
    for (const TreePart::Piece& piece : part.pieces) add_piece(piece);
    for (const TreePart::Factor& factor : part.factors) add_factor(factor);
    for (const TreePart::Inner& inner : part.inners) add_inner(inner);
    for (const int variable : part.complete) add_diagonal(variable);
  });
}

void BorderedElimination::add_diagonal(int variable) {
  const int first = dof_.first[variable], size = dof_.size[variable];
  // Multipliers have no diagonal block. Those of auxiliary variables are in add_inner().
  if (variable >= dof_.node_count + dof_.joint_count) return;
  for (int r = 0; r < size; ++r)
    for (int c = 0; c < size; ++c)
      if (is_placed_[first + r] && is_placed_[first + c])
        front_.row(front_.row_place(first + r))[front_.column_place(first + c)] +=
            blocks_.diagonal(variable)[size * c + r];
}

void BorderedElimination::add_closure(int k) {
  const LoopClosure& closure = model_.closures[k];
  const Eigen::MatrixXd& values = blocks_.closures[k];
  const int variable = dof_.variable_of_closure(k), distance = static_cast<int>(values.rows());
  const std::array<int, 3> first{6 * closure.child, 6 * closure.parent, dof_.first[variable]}, place{0, 6, 12},
      count{6, closure.parent < 0 ? 0 : 6, dof_.size[variable]};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (count[i] > 0 && count[j] > 0)
        front_.add(first[i], first[j], &values(place[i], place[j]), count[i], count[j], distance);
}

/// Adds the coupling without the blocks of nodes with themselves, which are in the diagonal blocks.
void BorderedElimination::add_coupling(int k) {
  const std::vector<int>& nodes = order_.coupled_nodes(k);
  const Eigen::MatrixXd& values = blocks_.couplings[k];
  const int distance = static_cast<int>(values.rows()), count = static_cast<int>(nodes.size());
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j)
      if (i != j) front_.add(6 * nodes[i], 6 * nodes[j], &values(6 * i, 6 * j), 6, 6, distance);
}

/// Adds the blocks of a piece's two nodes with each other.
void BorderedElimination::add_piece(const TreePart::Piece& piece) {
  const auto [a, b] = model_.force_elements[piece.coupling]->pieces().pairs[piece.index];
  const std::vector<int>& nodes = order_.coupled_nodes(piece.coupling);
  const Eigen::Map<Eigen::MatrixXd>& values = blocks_.pieces[piece.coupling].tangent.blocks;
  const Eigen::Index at = 12 * static_cast<Eigen::Index>(piece.index);
  front_.add(6 * nodes[a], 6 * nodes[b], &values(0, at + 6), 6, 6, 12);
  front_.add(6 * nodes[b], 6 * nodes[a], &values(6, at), 6, 6, 12);
}

/// Adds what couples a node with the auxiliary variables t of a group. Their equation is right x + inner t = 0, and
/// -left t stands in the rows of the nodes.
void BorderedElimination::add_factor(const TreePart::Factor& factor) {
  const int variable = order_.auxiliary(factor.coupling, factor.group), scalar = 6 * factor.node;
  const int first = dof_.first[variable], rank = dof_.size[variable];
  const PieceTangent& values = blocks_.pieces[factor.coupling].tangent;
  const Eigen::Index at = 6 * static_cast<Eigen::Index>(factor.place);
  front_.add(scalar, first, &values.left(at, 0), 6, rank, static_cast<int>(values.left.rows()));
  front_.add(first, scalar, &values.right(0, at), rank, 6, rank);
}

void BorderedElimination::add_inner(const TreePart::Inner& inner) {
  const int row = order_.auxiliary(inner.coupling, inner.row), column = order_.auxiliary(inner.coupling, inner.column);
  const int rank = dof_.size[row];
  const Eigen::Index at = rank * static_cast<Eigen::Index>(3 * inner.row + inner.column - inner.row + 1);
  front_.add(dof_.first[row], dof_.first[column], &blocks_.pieces[inner.coupling].tangent.inner(0, at), rank, rank,
             rank);
}

void BorderedElimination::add_remainder(const Factors& f) {
  const int size = f.size - f.pivots;
  const double* values = memory(f.remainder);
  runs_.clear();  // ranges of columns that are contiguous in this front as well
  for (int k = 0; k < size; ++k) {
    const int place = front_.column_place(scalars_[f.columns + f.pivots + k]);
    if (runs_.empty() || runs_.back().place + k - runs_.back().from != place) runs_.push_back({k, place, 0});
    ++runs_.back().count;
  }
  for (int i = 0; i < size; ++i, values += size) {
    double* to = front_.row(front_.row_place(scalars_[f.rows + f.pivots + i]));
    for (const Run& run : runs_)
      Eigen::Map<Eigen::VectorXd>(to + run.place, run.count) +=
          Eigen::Map<const Eigen::VectorXd>(values + run.from, run.count);
  }
}

// ---------------------------------------------------------------- factors

void BorderedElimination::keep(int pivots, Factors& f) {
  f.size = front_.active();
  f.pivots = pivots;
  f.delayed = candidates_ - pivots;
  f.stride = 4 * lanes_for(f.size);
  f.rows = scalars_.size();
  scalars_.insert(scalars_.end(), front_.rows.begin(), front_.rows.begin() + f.size);
  f.columns = scalars_.size();
  scalars_.insert(scalars_.end(), front_.columns.begin(), front_.columns.begin() + f.size);
  f.lower = allocate(f.stride * pivots);
  f.upper = allocate(f.stride * pivots);
  if (work_.size() < static_cast<std::size_t>(f.stride / 4)) work_.resize(f.stride / 4);
  f.reciprocals = allocate(pivots);
  f.forwarded = allocate(pivots);
  for (int k = 0; k < pivots; ++k) {
    const double* row = front_.row(k);
    std::copy_n(front_.lower(k), f.stride, memory(f.lower) + f.stride * k);
    std::copy_n(row, f.stride, memory(f.upper) + f.stride * k);
    std::fill_n(memory(f.upper) + f.stride * k, k + 1, 0.0);
    std::fill_n(memory(f.upper) + f.stride * k + f.size, f.stride - f.size, 0.0);
    memory(f.reciprocals)[k] = front_.reciprocal(k);
  }
}

void BorderedElimination::pass_on(const TreePart& part, Factors& f) {
  const int size = f.size - f.pivots;
  if (!part.passes_node) {
    f.remainder = allocate(size * size);
    for (int i = 0; i < size; ++i)
      std::copy_n(front_.row(f.pivots + i) + f.pivots, size, memory(f.remainder) + size * i);
  } else if (part.border_count > 0) {
    double* diagonal = blocks_.diagonal(*order_.border(part));
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) diagonal[6 * c + r] += front_.row(f.pivots + r)[f.pivots + c];
  }
}

}  // namespace flexarm
