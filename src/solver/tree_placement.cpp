// TreeOrder: the parts in their order, and where variables, closures and couplings belong.
#include <algorithm>
#include <iterator>
#include <utility>

#include "solver/tree_order.h"

namespace flexarm {

/// Lists the parts from the root to the leaves, each joint with the elements outboard of its slave; then reverses the
/// list. Leaves the list empty if not every node is reached exactly once.
void TreeOrder::order_parts() {
  std::vector<std::vector<TreePart>> outboard(model_.nodes.size());  // elements by their first node
  std::size_t parts_in_all = model_.joints.size();
  for_each_element(model_.beams, [&](const auto& element) {
    TreePart part;
    part.node_count = std::decay_t<decltype(element)>::kNodes;
    std::copy(element.nodes.begin(), element.nodes.end(), part.nodes.begin());
    part.first_block = element.first_block;
    outboard[element.nodes[0]].push_back(part);
    ++parts_in_all;
  });
  std::vector<char> reached(model_.nodes.size(), false);
  std::vector<TreePart> line;
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const JointMap& joint = model_.joints[j];
    if (joint.master >= 0 && !reached[joint.master]) return parts_.clear();
    reached[joint.slave] = true;
    parts_.emplace_back();
    parts_.back().joint = static_cast<int>(j);
    line = outboard[joint.slave];
    while (!line.empty()) {
      const TreePart part = line.back();
      line.pop_back();
      parts_.push_back(part);
      for (int i = 1; i < part.node_count; ++i) {
        const int node = part.nodes[i];
        if (dof_.slave_joint[node] >= 0) continue;  // its joint continues from here
        if (reached[node]) return parts_.clear();
        reached[node] = true;
        line.insert(line.end(), outboard[node].begin(), outboard[node].end());
      }
    }
  }
  const bool all_reached = std::all_of(reached.begin(), reached.end(), [](char is_reached) { return is_reached; });
  if (!all_reached || parts_.size() != parts_in_all) parts_.clear();
  // A slider must remain before all elements of its line, which may belong to several branches.
  if (model_.slide_lines.empty() &&
      std::any_of(couplings_.begin(), couplings_.end(), [](const Coupling& coupling) { return coupling.in_pieces; }))
    keep_branches_together();
  std::reverse(parts_.begin(), parts_.end());
}

/// Sorts the list from root to leaves such that each part is followed by all that is outboard of it, smaller branches
/// first. In the order of elimination, bodies on a beam then come between its elements, so that a line over these
/// bodies has only few of them in each border.
void TreeOrder::keep_branches_together() {
  const int count = static_cast<int>(parts_.size());
  std::vector<int> reached_by(model_.nodes.size(), -1), parent(count, -1), size(count, 1);
  for (int p = 0; p < count; ++p) {
    const TreePart& part = parts_[p];
    if (part.joint < 0) {
      parent[p] = reached_by[part.nodes[0]];
      for (int i = 1; i < part.node_count; ++i)
        if (dof_.slave_joint[part.nodes[i]] < 0) reached_by[part.nodes[i]] = p;
      continue;
    }
    const JointMap& joint = model_.joints[part.joint];
    if (joint.master >= 0) parent[p] = reached_by[joint.master];
    reached_by[joint.slave] = p;
  }
  std::vector<std::vector<int>> outboard(count + 1);  // the last one: of the world
  for (int p = count - 1; p >= 0; --p) {
    if (parent[p] >= 0) size[parent[p]] += size[p];
    outboard[parent[p] < 0 ? count : parent[p]].push_back(p);
  }
  std::vector<TreePart> sorted;
  std::vector<int> line = {count};
  while (!line.empty()) {
    const int p = line.back();
    line.pop_back();
    if (p < count) sorted.push_back(parts_[p]);
    std::stable_sort(outboard[p].begin(), outboard[p].end(), [&](int a, int b) { return size[a] > size[b]; });
    line.insert(line.end(), outboard[p].begin(), outboard[p].end());
  }
  parts_ = std::move(sorted);
}

void TreeOrder::place_variables() {
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const TreePart& part = parts_[p];
    if (part.joint >= 0) {
      completion_[model_.joints[part.joint].slave] = completion_[dof_.variable_of_joint(part.joint)] =
          static_cast<int>(p);
      continue;
    }
    for (int i = 1; i < part.node_count; ++i)
      if (dof_.slave_joint[part.nodes[i]] < 0) completion_[part.nodes[i]] = static_cast<int>(p);
  }
  // An element's tangent is needed as soon as one of its nodes is eliminated.
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const TreePart& part = parts_[p];
    if (part.joint >= 0) continue;
    int first = completion_[part.nodes[0]];
    for (int i = 1; i < part.node_count; ++i) first = std::min(first, completion_[part.nodes[i]]);
    parts_[first].elements.push_back(static_cast<int>(p));
  }
}

/// A coordinate that others follow is complete when all of these are folded into it. The list of mimics is ordered such
/// that no master is the slave of an earlier entry.
void TreeOrder::place_mimics() {
  for (std::size_t i = 0; i < dof_.mimics.size(); ++i) {
    const auto& [slave, master, coordinate] = dof_.mimics[i];
    int& completion = completion_[master];
    completion = std::max(completion, completion_[slave]);
  }
  for (std::size_t i = 0; i < dof_.mimics.size(); ++i)
    parts_[completion_[dof_.mimics[i].slave_variable]].mimics.push_back(static_cast<int>(i));
}

std::vector<int> TreeOrder::path_to_root(int node) const {
  std::vector<int> path;
  while (node >= 0) {
    path.push_back(completion_[node]);
    const TreePart& part = parts_[path.back()];
    node = part.joint < 0 ? part.nodes[0] : model_.joints[part.joint].master;
  }
  return path;
}

int TreeOrder::last_part_of_line(const SlideLine& line) const {
  int last = -1;
  for (std::size_t i = 1; i < line.nodes.size(); ++i) last = std::max(last, completion_[line.nodes[i]]);
  return last;
}

/// Places closures. The two branches of a loop have met when all parts on the path between its two nodes are
/// eliminated, and the lines of the sliders on this path.
void TreeOrder::place_closures() {
  for (std::size_t k = 0; k < model_.closures.size(); ++k) {
    const LoopClosure& closure = model_.closures[k];
    const int variable = dof_.variable_of_closure(static_cast<int>(k));
    std::vector<int> child = path_to_root(closure.child), parent = path_to_root(closure.parent), way;
    completion_[variable] = parent.empty() ? child[0] : std::min(child[0], parent[0]);
    std::sort(child.begin(), child.end());
    std::sort(parent.begin(), parent.end());
    std::set_symmetric_difference(child.begin(), child.end(), parent.begin(), parent.end(), std::back_inserter(way));
    int last = completion_[variable];
    for (const int p : way) {
      last = std::max(last, p);
      const int joint = parts_[p].joint;
      if (joint >= 0 && model_.joints[joint].kind == JointMapKind::Slide)
        last = std::max(last, last_part_of_line(model_.slide_lines[model_.joints[joint].line]));
    }
    last_[variable] = last;
    TreePart& part = parts_[completion_[variable]];
    part.closures.push_back(static_cast<int>(k));
    part.complete.push_back(variable);
  }
}

/// Places each coupling in the part in which the first of its nodes is complete.
void TreeOrder::place_couplings() {
  for (TreePart& part : parts_) part.first_coupling = -1;
  for (std::size_t k = couplings_.size(); k-- > 0;) {
    Coupling& coupling = couplings_[k];
    if (coupling.nodes.size() < 2 || coupling.in_pieces) continue;
    int first = completion_[coupling.nodes[0]];
    for (const int node : coupling.nodes) first = std::min(first, completion_[node]);
    coupling.next = parts_[first].first_coupling;
    parts_[first].first_coupling = static_cast<int>(k);
  }
}

/// Places each piece in the part in which the first of its two nodes is complete.
void TreeOrder::place_pieces() {
  for (int k = 0; k < static_cast<int>(couplings_.size()); ++k) {
    const std::vector<int>& nodes = couplings_[k].nodes;
    const std::vector<std::array<int, 2>>& pairs = model_.force_elements[k]->pieces().pairs;
    for (int p = 0; p < static_cast<int>(pairs.size()); ++p) {
      const auto [a, b] = pairs[p];
      if (a < 0 || b < 0 || a == b) continue;  // it couples no nodes
      parts_[std::min(completion_[nodes[a]], completion_[nodes[b]])].pieces.push_back({k, p});
    }
    if (couplings_[k].auxiliary_count > 0) place_groups(k);
  }
}

/// Places the factors of the groups, node by node, where the node is complete. The auxiliary variable is complete with
/// the last of the group's nodes, or, if it has none, with a neighbour. Couplings of two groups are placed in the part
/// in which the first of both is complete.
void TreeOrder::place_groups(int k) {
  const std::vector<std::vector<int>>& groups = model_.force_elements[k]->pieces().groups;
  const int count = static_cast<int>(groups.size());
  int* const last = &completion_[auxiliary(k, 0)];
  int place = 0;
  for (int g = 0; g < count; ++g)
    for (const int i : groups[g]) {
      const int node = couplings_[k].nodes[i];
      parts_[completion_[node]].factors.push_back({k, g, node, place++});
      last[g] = std::max(last[g], completion_[node]);
    }
  for (int g = 1; g < count; ++g)
    if (last[g] < 0) last[g] = last[g - 1];
  for (int g = count - 1; g-- > 0;)
    if (last[g] < 0) last[g] = last[g + 1];
  for (int g = 0; g < count; ++g)
    for (int other = std::max(g - 1, 0); other < std::min(g + 2, count); ++other)
      parts_[std::min(last[g], last[other])].inners.push_back({k, g, other});
}

}  // namespace flexarm
