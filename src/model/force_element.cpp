#include "model/force_element.h"

#include "model/state.h"

namespace flexarm {

void find_nodes(const ForceElement& element, const std::vector<NodePose>& poses, std::vector<int>& nodes) {
  nodes.resize(element.most_nodes());
  nodes.resize(element.find_nodes(poses, nodes.data()));
}

std::vector<std::vector<int>> nodes_of(const ForceElementList& elements, const State& state) {
  std::vector<std::vector<int>> nodes(elements.size());
  if (elements.empty()) return nodes;
  std::vector<NodePose> poses;
  for (const NodeState& node : state.nodes) poses.push_back(node_pose(node));
  for (std::size_t k = 0; k < elements.size(); ++k) find_nodes(*elements[k], poses, nodes[k]);
  return nodes;
}

}  // namespace flexarm
