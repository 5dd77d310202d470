#pragma once
/// Distances that the nodes of a mechanism move in a small motion.

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "analysis/modes.h"
#include "integrators/step_system.h"
#include "model/model.h"

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
  /// Name of the link with the node that goes farthest.
  std::string link() const {
    const auto way = [&](const LinkFrame& link) {
      const int first = link.frame.node, last = link.beam ? link.beam->tip.node : first;
      return first < 0 ? 0.0 : *std::max_element(ways_.begin() + first, ways_.begin() + last + 1);
    };
    return std::max_element(model_.links.begin(), model_.links.end(),
                            [&](const LinkFrame& a, const LinkFrame& b) { return way(a) < way(b); })
        ->name;
  }

 private:
  const Model& model_;
  std::vector<double> ways_;  // per node
};

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
