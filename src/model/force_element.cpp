#include "model/force_element.h"

#include <numeric>

#include <Eigen/LU>

#include "model/state.h"

namespace flexarm {

std::size_t ForcePieces::group_nodes() const {
  return std::accumulate(groups.begin(), groups.end(), std::size_t{0},
                         [](std::size_t sum, const std::vector<int>& group) { return sum + group.size(); });
}

PieceTangent PieceTangent::in(double* numbers, const ForcePieces& pieces) {
  const auto count = static_cast<Eigen::Index>(pieces.pairs.size()), rank = static_cast<Eigen::Index>(pieces.rank);
  const Eigen::Index size = rank == 0 ? 0 : 6 * static_cast<Eigen::Index>(pieces.group_nodes());
  const Eigen::Index inner = rank == 0 ? 0 : 3 * rank * static_cast<Eigen::Index>(pieces.groups.size());
  double *left = numbers + 144 * count, *right = left + size * rank;
  return {{numbers, 12, 12 * count}, {left, size, rank}, {right, rank, size}, {right + size * rank, rank, inner}};
}

void PieceTangent::set_zero() {
  for (auto* matrix : {&blocks, &left, &right, &inner}) matrix->setZero();
  const Eigen::Index rank = inner.rows();
  for (Eigen::Index own = rank; own < inner.cols(); own += 3 * rank) inner.middleCols(own, rank).setIdentity();
}

Eigen::MatrixXd PieceTangent::sum(const ForcePieces& pieces, std::size_t nodes) const {
  const auto size = static_cast<Eigen::Index>(6 * nodes);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t p = 0; p < pieces.pairs.size(); ++p)
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        if (pieces.pairs[p][i] >= 0 && pieces.pairs[p][j] >= 0)
          out.block<6, 6>(6 * pieces.pairs[p][i], 6 * pieces.pairs[p][j]) +=
              blocks.block<6, 6>(6 * i, static_cast<Eigen::Index>(12 * p) + 6 * j);
  if (pieces.rank == 0) return out;
  const Eigen::Index rank = pieces.rank, groups = static_cast<Eigen::Index>(pieces.groups.size()), all = rank * groups;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(all, all), of_nodes = Eigen::MatrixXd::Zero(all, size),
                  by_nodes = Eigen::MatrixXd::Zero(size, all);
  Eigen::Index at = 0;
  for (Eigen::Index g = 0; g < groups; ++g) {
    for (const int node : pieces.groups[g]) {
      of_nodes.block(rank * g, 6 * node, rank, 6) = right.middleCols<6>(at);
      by_nodes.block(6 * node, rank * g, 6, rank) = left.middleRows<6>(at);
      at += 6;
    }
    for (Eigen::Index other = std::max<Eigen::Index>(g - 1, 0); other < std::min(g + 2, groups); ++other)
      whole.block(rank * g, rank * other, rank, rank) = inner.middleCols(rank * (3 * g + other - g + 1), rank);
  }
  out += by_nodes * whole.partialPivLu().solve(of_nodes);
  return out;
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
