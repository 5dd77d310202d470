#pragma once
/// The fronts of all elements of a tree that have no border. (docs/notes/tree.md)

#include <array>
#include <cstddef>
#include <vector>

#include "solver/element_front.h"
#include "solver/tree_order.h"

namespace flexarm {

/// Eliminates elements with `Unknowns` unknowns per node, see ElementFront. Memory layout: blocks of elements and of
/// nodes are ElementFront::kBlock apart, values of nodes kColumn.
template <int Unknowns>
class ElementElimination {
 public:
  /// The order must outlive this object.
  explicit ElementElimination(const TreeOrder& order) : order_(order) {
    std::size_t pivots = 0;
    for (const TreePart& part : order.parts()) {
      first_pivot_.push_back(pivots);
      if (part.node_count > 0) pivots += Unknowns * (part.node_count - 1);
    }
    pivots_.resize(pivots);
    condensed_.resize(order.parts().size(), nullptr);
  }

  /// Tells that the interior nodes of an element are eliminated elsewhere. Its front then has only the two nodes at its
  /// ends, with `blocks` in place of `elements`. With null, the front has all nodes of the element, as initially.
  void set_condensed(int part, double* blocks) { condensed_[part] = blocks; }

  /// For a part that is an element. If `values` is not null, right-hand sides get their forward elimination as well.
  /// Returns false if a pivot is zero or not finite.
  bool eliminate(int part, double* elements, double* diagonals, double* values) {
    const std::array<double*, 5> at_nodes = of_nodes(part, diagonals, Front<2>::kBlock);
    std::array<double*, 5> r{};
    if (values) r = of_nodes(part, values, Front<2>::kColumn);
    return with_front(part, [&](auto front) {
      return front.eliminate(block(part, elements), at_nodes.data(), pivots_.data() + first_pivot_[part],
                             values ? r.data() : nullptr);
    });
  }
  void forward(int part, double* elements, double* values) const {
    const std::array<double*, 5> r = of_nodes(part, values, Front<2>::kColumn);
    with_front(
        part, [&](auto front) { front.forward(block(part, elements), pivots_.data() + first_pivot_[part], r.data()); });
  }
  void backward(int part, double* elements, double* values) const {
    const std::array<double*, 5> r = of_nodes(part, values, Front<2>::kColumn);
    with_front(part, [&](auto front) { front.backward(block(part, elements), r.data()); });
  }

 private:
  template <int Nodes>
  using Front = ElementFront<Nodes, Unknowns>;

  double* block(int part, double* elements) const {
    return condensed_[part] ? condensed_[part] : elements + Front<2>::kBlock * order_.parts()[part].first_block;
  }
  std::array<double*, 5> of_nodes(int p, double* first, std::size_t size) const {
    const TreePart& part = order_.parts()[p];
    std::array<double*, 5> places{};
    for (int i = 0; i < part.node_count; ++i) places[i] = first + size * part.nodes[i];
    if (condensed_[p]) places[1] = places[part.node_count - 1];
    return places;
  }
  template <class Visitor>
  auto with_front(int part, Visitor&& visit) const {
    switch (condensed_[part] ? 2 : order_.parts()[part].node_count) {
      case 2:
        return visit(Front<2>());
      case 3:
        return visit(Front<3>());
      case 4:
        return visit(Front<4>());
      default:
        return visit(Front<5>());
    }
  }

  const TreeOrder& order_;
  std::vector<std::size_t> first_pivot_;  // per part
  std::vector<unsigned char> pivots_;
  std::vector<double*> condensed_;  // per part: blocks of the two end nodes, or null
};

}  // namespace flexarm
