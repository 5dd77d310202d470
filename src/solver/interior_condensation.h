#pragma once
/// Elimination of elements' interior nodes, four elements side by side, before the fronts of the elements. (tree.md)

#include <array>
#include <tuple>
#include <vector>

#include "elements/conserving_element.h"
#include "math/pack.h"
#include "model/model.h"
#include "solver/tree_blocks.h"
#include "solver/tree_order.h"

namespace flexarm {

/// Four elements of a group, the last one again where the group has no more.
template <int Nodes>
struct CondensedPack {
  static constexpr int kLanes = Pack::kLanes;

  int lanes = 0;  ///< in use
  std::array<std::array<int, Nodes>, kLanes> nodes;
  std::array<int, kLanes> parts, first_block;
  /// The tangent, with i the interior nodes and e those at the ends, and what takes its place:
  ///   A_ii  rows of L, without its diagonal, and U, with the reciprocals of its diagonal
  ///   A_ie  X = A_ii^-1 A_ie
  ///   A_ei  stays
  ///   A_ee  A_ee - A_ei X, no longer side by side: the blocks (0, 0), (0, 1), (1, 0), (1, 1) of the ends of one lane
  ///         are in the place of the pack's block (0, 0), of the next lane in that of (0, 1), and so on.
  BlockSystem<Nodes, Pack> system;
  bool is_ready = false;      ///< of the tangent evaluated last
  bool is_condensed = false;  ///< else its elements are whole
};

/// Static condensation of the nodes that nothing but their own element couples, and what stands on their diagonal: of
/// an element of `Nodes` nodes two are left for its front, ElementFront<2>. Packs with an element that has a border, on
/// which others hang between its ends, or whose pivots have to be searched for are left whole.
class InteriorCondensation {
 public:
  /// Both must outlive it.
  InteriorCondensation(const Model& model, const TreeOrder& order);

  /// Where the tangent of four elements from element 4 `pack` of their group on is to be evaluated.
  template <int Nodes>
  BlockSystem<Nodes, Pack>& system(std::size_t pack) {
    return std::get<std::vector<CondensedPack<Nodes>>>(groups_)[pack].system;
  }

  /// All packs have been evaluated.
  void begin();
  /// Before the elimination of the front that takes an element: eliminates the interior nodes of its pack, unless that
  /// is done, and returns the element's four blocks of the nodes at its ends, for ElementFront<2>. Or writes those of
  /// all its nodes into `blocks` and returns null; so for elements of two nodes, which stand there. Right-hand sides, 6
  /// values per node, if `values` is not null, go through forward() on the way.
  double* prepare(int part, TreeBlocks& blocks, double* values);
  /// Forward elimination: r_i <- A_ii^-1 r_i, r_e <- r_e - A_ei r_i. To be followed by that of the fronts.
  void forward(double* values) const;
  /// Back substitution, after that of the fronts: r_i <- r_i - X r_e.
  void backward(double* values) const;

 private:
  struct Place {
    int pack = -1, lane = 0;
  };

  template <int Nodes>
  double* prepare(const Place& place, TreeBlocks& blocks, double* values);
  template <int Nodes>
  bool keeps_interiors(const CondensedPack<Nodes>& pack) const;

  const TreeOrder& order_;
  std::tuple<std::vector<CondensedPack<3>>, std::vector<CondensedPack<4>>, std::vector<CondensedPack<5>>> groups_;
  std::vector<Place> places_;  // per part
};

}  // namespace flexarm
