#include "model/force_element.h"

#include "model/state.h"

namespace flexarm {

PieceTangent PieceTangent::in(double* numbers, const ForcePieces& pieces, std::size_t nodes) {
  const auto size = static_cast<Eigen::Index>(6 * nodes);
  const Eigen::Index count = static_cast<Eigen::Index>(pieces.pairs.size()), rank = pieces.rank;
  double *left = numbers + 144 * count, *right = left + size * rank;
  return {{numbers, 12, 12 * count}, {left, size, rank}, {right, rank, size}};
}

void find_nodes(const ForceElement& element, const ForceStart& start, std::vector<int>& nodes) {
  nodes.resize(element.most_nodes());
  nodes.resize(element.find_nodes(start, nodes.data()));
}

std::size_t memory_begin(const ForceElementList& elements, std::size_t index) {
  std::size_t begin = 0;
  for (std::size_t k = 0; k < index; ++k) begin += elements.at(k)->memory_size();
  return begin;
}

std::vector<const double*> memories_of(const ForceElementList& elements, const std::vector<double>& force_memory) {
  std::vector<const double*> memories;
  const double* memory = force_memory.data();
  for (const auto& element : elements) {
    memories.push_back(memory);
    memory += element->memory_size();
  }
  return memories;
}

std::vector<std::vector<int>> nodes_of(const ForceElementList& elements, const State& state) {
  std::vector<std::vector<int>> nodes(elements.size());
  if (elements.empty()) return nodes;
  std::vector<NodePose> poses;
  std::vector<Vector6> velocities;
  for (const NodeState& node : state.nodes) {
    poses.push_back(node_pose(node));
    velocities.push_back(spatial_velocity(node));
  }
  for (std::size_t k = 0; k < elements.size(); ++k) find_nodes(*elements[k], {poses, velocities}, nodes[k]);
  return nodes;
}

}  // namespace flexarm
