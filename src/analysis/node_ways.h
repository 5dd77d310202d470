#pragma once
/// Distances that the nodes of a mechanism move in a small motion.

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "analysis/modes.h"
#include "integrators/step_system.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// How far each node moves: the displacement over the model's length scale, or the rotation in rad if that is larger.
class NodeWays {
 public:
  NodeWays(const Model& model, const std::vector<ComplexVector6>& motion) : model_(model) {
    for (const ComplexVector6& node : motion)
      ways_.push_back(std::max(node.head<3>().norm() / model.length_scale, node.tail<3>().norm()));
  }

  double largest() const { return *std::max_element(ways_.begin(), ways_.end()); }
  double sum_of_squares() const { return std::inner_product(ways_.begin(), ways_.end(), ways_.begin(), 0.0); }
  /// The link with the node that goes farthest, by its name and its index.
  std::string link() const { return model_.links[link_index()].name; }
  int link_index() const {
    const auto way = [&](const LinkFrame& link) {
      const int first = link.frame.node, last = link.beam ? link.beam->tip.node : first;
      return first < 0 ? 0.0 : *std::max_element(ways_.begin() + first, ways_.begin() + last + 1);
    };
    const auto farthest = std::max_element(model_.links.begin(), model_.links.end(),
                                           [&](const LinkFrame& a, const LinkFrame& b) { return way(a) < way(b); });
    return static_cast<int>(farthest - model_.links.begin());
  }

 private:
  const Model& model_;
  std::vector<double> ways_;  // per node
};

/// {displacement, rotation vector} of all nodes between two states, less than half a turn.
inline std::vector<ComplexVector6> ways_between(const State& from, const State& to) {
  std::vector<ComplexVector6> ways;
  ways.reserve(from.nodes.size());
  for (std::size_t i = 0; i < from.nodes.size(); ++i) {
    const Eigen::AngleAxisd turn(to.nodes[i].orientation * from.nodes[i].orientation.conjugate());
    Vector6 way;
    way << to.nodes[i].position - from.nodes[i].position, turn.angle() * turn.axis();
    ways.emplace_back(way.cast<std::complex<double>>());
  }
  return ways;
}

/// Motion of all nodes in the last solution of the system's tangent.
inline std::vector<ComplexVector6> node_motion_of_solution(StepSystem& system) {
  const DegreesOfFreedom& dof = system.degrees_of_freedom();
  const double* scalars = system.tangent().expanded_solution();
  std::vector<ComplexVector6> motion;
  motion.reserve(dof.node_count);
  for (int node = 0; node < dof.node_count; ++node)
    motion.emplace_back(Eigen::Map<const Vector6>(scalars + dof.first[node]).cast<std::complex<double>>());
  return motion;
}

}  // namespace flexarm
