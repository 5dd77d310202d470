#pragma once
/// The order in which a mechanism's tangent is eliminated, from the leaves to the root, and which variables each of its
/// parts couples. (beyond.md 7, tree.md)

#include <array>
#include <vector>

#include "model/degrees_of_freedom.h"

namespace flexarm {

/// A joint, which folds its slave, or an element, which eliminates its outboard nodes.
struct TreePart {
  int joint = -1;  ///< -1: an element
  int node_count = 0;
  std::array<int, 5> nodes{};  ///< of the element
  std::size_t first_block = 0;

  // ---- what is added or complete here; indices of parts, closures, DegreesOfFreedom::mimics, variables
  std::vector<int> elements, closures, mimics, complete;

  // ---- these follow the sliders
  int first_border = 0, border_count = 0;   ///< in TreeOrder::border(): what remains, eliminated by later parts
  int first_child = -1, next_sibling = -1;  ///< parts that pass on what more than one node couples
  int front = -1;                           ///< the part in whose front this one is eliminated: itself, mostly
  int first_coupling = -1;                  ///< of those added here, see TreeOrder::next_coupling(); -1: none
  int first_member = -1, next_member = -1;  ///< of those in its own front; behind this one in its front, -1: none
  bool has_border = false;                  ///< more is coupled here than the part's own nodes and coordinates
  bool passes_node = true;                  ///< what remains is a 6 x 6 block of the inboard node, or nothing
  bool keeps_interior = false;              ///< an element without border, between whose ends nobody leaves anything
};

/// The parts in the order of their elimination, as a multifrontal method takes them: a variable is eliminated in the
/// part in which its row is complete, and what the part leaves over its border goes to the first part that eliminates a
/// variable of that border. In a tree of joints and elements every border is the inboard node alone. A slider puts its
/// line's active nodes there, a closure its other node and its multipliers, a mimicking coordinate the one it follows,
/// a beam whose far end another joint holds that joint's master, a force element its other nodes: until their own parts
/// come, they ride along.
class TreeOrder {
 public:
  TreeOrder(const Model& model, const DegreesOfFreedom& dof);

  /// False if a node is no joint's slave and no chain of elements leads to it from one, or more than one does.
  bool is_complete() const { return complete_; }
  const std::vector<TreePart>& parts() const { return parts_; }
  /// Part in which a variable's row and column are complete, per variable.
  int completion(int variable) const { return completion_[variable]; }
  /// Most scalars in a part's front that only earlier parts have brought there, or a slider, whatever the windows.
  int most_riders(int part) const { return most_riders_[part]; }
  const int* border(const TreePart& part) const { return border_.data() + part.first_border; }
  /// Active nodes of the line on which a joint's slave slides.
  NodeRange window(int joint) const { return windows_[joint]; }
  void set_window(int joint, NodeRange window);
  /// The nodes that a force element couples now, and the next one that is added in the same part; -1: none. Those of
  /// less than two nodes are added nowhere.
  const std::vector<int>& coupled_nodes(int coupling) const { return couplings_[coupling].nodes; }
  int next_coupling(int coupling) const { return couplings_[coupling].next; }
  void set_coupling(int coupling, const int* nodes, int count);
  /// Finds the borders anew where a window or a coupling has changed. No allocation.
  void update();

 private:
  void order_parts();
  void place_variables();
  void place_mimics();
  void place_closures();
  void place_couplings();
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
  const DegreesOfFreedom& dof_;
  bool complete_ = false, old_ = true;
  std::vector<TreePart> parts_;
  /// Per variable: part in which it is complete, and up to which it stays in borders: multipliers until both branches
  /// of their loop have met, for only then is their elimination certain to succeed.
  std::vector<int> completion_, last_;
  std::vector<NodeRange> windows_;  // per joint
  struct Coupling {
    std::vector<int> nodes;
    int next = -1;
  };
  std::vector<Coupling> couplings_;  // per force element
  std::vector<int> border_, visited_, most_riders_;
  std::vector<char> receives_;  // per node: a part leaves its block there
};

}  // namespace flexarm
