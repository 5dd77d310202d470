#include "model/force_element.h"

#include "model/state.h"

namespace flexarm {

std::vector<int> nodes_of(const ForceElement& element, const State& state) {
  std::vector<NodePose> poses;
  for (const NodeState& node : state.nodes) poses.push_back(node_pose(node));
  std::vector<int> nodes(element.most_nodes());
  nodes.resize(element.find_nodes(poses, nodes.data()));
  return nodes;
}

}  // namespace flexarm
