#pragma once
/// Finds the order in which a mechanism's tangent is eliminated, from the leaves to the root, and the variables that
/// each part of the mechanism couples. (docs/notes/beyond.md 7, docs/notes/tree.md)

#include <array>
#include <vector>

#include "model/degrees_of_freedom.h"

namespace flexarm {

/// A step of the elimination: a joint, whose slave is folded, or an element, whose outboard nodes are eliminated.
struct TreePart {
  int joint = -1;  ///< -1: an element
  int node_count = 0;
  std::array<int, 5> nodes{};  ///< of an element
  std::size_t first_block = 0;

  // ---- what is added or becomes complete here: indices of parts, closures, DegreesOfFreedom::mimics, variables
  std::vector<int> elements, closures, mimics, complete;
  /// A piece of a coupling; see ForcePieces.
  struct Piece {
    int coupling, index;
  };
  std::vector<Piece> pieces;
  /// A node that is complete here, and a group with which it is coupled. `place`: of the node in PieceTangent::left.
  struct Factor {
    int coupling, group, node, place;
  };
  std::vector<Factor> factors;
  /// Rows and columns of two groups of which the first is complete here.
  struct Inner {
    int coupling, row, column;
  };
  std::vector<Inner> inners;

  // ---- these depend on the windows of sliders and on the nodes of couplings
  int first_border = 0, border_count = 0;   ///< in TreeOrder::border(): variables that later parts eliminate
  int first_child = -1, next_sibling = -1;  ///< list of parts that pass a remainder of more than one node to this part
  int front = -1;                           ///< part in whose front this one is eliminated; usually itself
  int first_coupling = -1;                  ///< list of couplings added here, see TreeOrder::next_coupling(); -1: none
  int first_member = -1, next_member = -1;  ///< first part in its own front; next part in a shared front; -1: none
  /// Whether tangents of force elements are added here.
  bool couples_forces() const { return first_coupling >= 0 || !pieces.empty() || !factors.empty() || !inners.empty(); }
  bool has_border = false;      ///< it couples more than the nodes and coordinates of this part
  bool passes_node = true;      ///< the remainder is a 6 x 6 block of the inboard node, or nothing
  bool keeps_interior = false;  ///< element without border; no part leaves a remainder between its ends
};

/// All parts in the order of elimination, for a multifrontal method: each part assembles a dense matrix, its front, of
/// the variables that it couples. A variable is eliminated in the part in which its row becomes complete. The remainder
/// of a part couples the variables of its border, and goes to the first part that eliminates one of these. In a tree of
/// joints and elements every border is just the inboard node. Other variables join a border and ride along, as riders,
/// until their own part comes: for a slider the active nodes of its line, for a closure its other node and its
/// multipliers, for a mimic coordinate the one that it follows, for a beam whose far end is held by another joint the
/// master of that joint, for a force element its other nodes. A force element in pieces couples the two nodes of each
/// piece. Each of its groups has an auxiliary variable, which rides from the group's first node to its last one.
class TreeOrder {
 public:
  TreeOrder(const Model& model, const DegreesOfFreedom& dof);

  /// The degrees of freedom, and behind them the auxiliary variables of force elements.
  const DegreesOfFreedom& dof() const { return dof_; }
  /// The auxiliary variable of a group of a force element; see ForcePieces.
  int auxiliary(int coupling, int group) const { return couplings_[coupling].first_auxiliary + group; }
  int auxiliary_count(int coupling) const { return couplings_[coupling].auxiliary_count; }
  /// False if a node is no slave of a joint and not exactly one chain of elements leads to it from a slave.
  bool is_complete() const { return complete_; }
  const std::vector<TreePart>& parts() const { return parts_; }
  /// Per variable: the part in which its row and column become complete.
  int completion(int variable) const { return completion_[variable]; }
  /// Upper bound, for any windows, of the number of riders in a part's front: scalars that are there only because an
  /// earlier part or a slider couples them.
  int most_riders(int part) const { return most_riders_[part]; }
  const int* border(const TreePart& part) const { return border_.data() + part.first_border; }
  /// Active nodes of the line of a slider.
  NodeRange window(int joint) const { return windows_[joint]; }
  void set_window(int joint, NodeRange window);
  /// The nodes that a force element couples now, and the next coupling in the same part; -1: none. Couplings of less
  /// than two nodes, and those in pieces, belong to no part.
  const std::vector<int>& coupled_nodes(int coupling) const { return couplings_[coupling].nodes; }
  int next_coupling(int coupling) const { return couplings_[coupling].next; }
  void set_coupling(int coupling, const int* nodes, int count);
  /// Finds the borders again if a window or a coupling has changed. Does not allocate memory.
  void update();

 private:
  void order_parts();
  void keep_branches_together();
  void place_variables();
  void place_mimics();
  void place_closures();
  void place_couplings();
  void place_pieces();
  void place_groups(int coupling);
  std::vector<std::vector<int>> parts_of_variables() const;
  std::vector<int> elimination_tree(std::vector<std::vector<int>> parts) const;
  void count_riders();
  void count_riders_of_couplings(const std::vector<int>& next);
  std::vector<int> path_to_root(int node) const;
  int last_part_of_line(const SlideLine& line) const;
  void find_borders();
  void find_border(int index);
  void find_fronts();
  bool may_join(const TreePart& part, const TreePart& next) const;
  void find_kept_interiors();
  template <class Visit>
  void for_each_coupled(const TreePart& part, const Visit& visit) const;
  template <class Visit>
  void for_each_of_its_own(const TreePart& part, const Visit& visit) const;

  const Model& model_;
  DegreesOfFreedom dof_;
  bool complete_ = false, old_ = true;
  std::vector<TreePart> parts_;
  /// Per variable: the part in which it is complete, and the last part up to which it may be in borders. They differ
  /// for multipliers, whose elimination is certain to succeed only when both branches of their loop have met.
  std::vector<int> completion_, last_;
  std::vector<NodeRange> windows_;  // per joint
  struct Coupling {
    std::vector<int> nodes;
    int next = -1;
    bool in_pieces = false;
    int first_auxiliary = -1, auxiliary_count = 0;
  };
  std::vector<Coupling> couplings_;  // per force element
  std::vector<int> border_, visited_, most_riders_;
  std::vector<char> receives_;  // per node: whether a part adds its remainder to the node's block
};

}  // namespace flexarm
