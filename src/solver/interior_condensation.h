#pragma once
/// Eliminates the interior nodes of elements, four elements side by side, before the fronts of the elements.
/// (docs/notes/tree.md)

#include <array>
#include <tuple>
#include <vector>

#include "elements/conserving_element.h"
#include "math/pack.h"
#include "model/model.h"
#include "solver/tree_blocks.h"
#include "solver/tree_order.h"

namespace flexarm {

/// Four elements of a group. If the group does not fill the last pack, its last element is repeated.
template <int Nodes>
struct CondensedPack {
  static constexpr int kLanes = Pack::kLanes;

  int lanes = 0;  ///< number of lanes in use
  std::array<std::array<int, Nodes>, kLanes> nodes;
  std::array<int, kLanes> parts, first_block;
  /// The tangent, with i the interior nodes and e the end nodes. After condensation its blocks contain:
  ///   A_ii  rows of L, without its diagonal, and of U, with the reciprocals of its diagonal
  ///   A_ie  X = A_ii^-1 A_ie
  ///   A_ei  unchanged
  ///   A_ee  A_ee - A_ei X, not side by side: the blocks (0, 0), (0, 1), (1, 0), (1, 1) of the first lane's end nodes
  ///         are in place of the pack's block (0, 0), those of the second lane in place of (0, 1), and so on.
  BlockSystem<Nodes, Pack> system;
  bool is_ready = false;      ///< prepare() was called for the last tangent
  bool is_condensed = false;  ///< false: all nodes of its elements are left to the fronts
};

/// Static condensation of the nodes that only their own element and their diagonal blocks couple. Of an element with
/// `Nodes` nodes, two are left for its front, ElementFront<2>. A pack is left whole if one of its elements has a
/// border, receives a remainder of another part at an interior node, or needs a search for pivots.
class InteriorCondensation {
 public:
  /// Both arguments must outlive this object.
  InteriorCondensation(const Model& model, const TreeOrder& order);

  /// The memory in which the tangent of the elements 4 `pack` to 4 `pack` + 3 of their group is to be evaluated.
  template <int Nodes>
  BlockSystem<Nodes, Pack>& system(std::size_t pack) {
    return std::get<std::vector<CondensedPack<Nodes>>>(groups_)[pack].system;
  }

  /// To be called when all packs have been evaluated.
  void begin();
  /// To be called before the front of an element is eliminated. Eliminates the interior nodes of the element's pack,
  /// unless that is done, and returns the element's four blocks of its end nodes, for ElementFront<2>. If the pack is
  /// left whole: writes the blocks of all nodes into `blocks` and returns null. Elements of two nodes need neither, and
  /// also return null. If `values` is not null, right-hand sides, 6 values per node, get their forward elimination as
  /// well.
  double* prepare(int part, TreeBlocks& blocks, double* values);
  /// Forward elimination: r_i <- A_ii^-1 r_i, r_e <- r_e - A_ei r_i. To be called before that of the fronts.
  void forward(double* values) const;
  /// Back substitution: r_i <- r_i - X r_e. To be called after that of the fronts.
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
