#include "analysis/passed_contacts.h"

#include <algorithm>
#include <vector>

namespace flexarm {
namespace {

/// Duration of a motion that is so fast that only its ends and its way matter, not the duration of hits [s].
constexpr double kAtOnce = 1e-12;

std::vector<NodePose> poses_of(const State& state) {
  std::vector<NodePose> poses;
  poses.reserve(state.nodes.size());
  for (const NodeState& node : state.nodes) poses.push_back(node_pose(node));
  return poses;
}

}  // namespace

bool pass_through(const Model& model, const State& from, const State& to) {
  const ForceElementList& elements = model.force_elements;
  if (std::none_of(elements.begin(), elements.end(), [](const auto& element) { return element->hits(); })) return false;
  const std::vector<NodePose> begin = poses_of(from), end = poses_of(to);
  const std::vector<Vector6> velocities(begin.size(), Vector6::Zero());
  const std::vector<const double*> memories = memories_of(elements, from.force_memory);
  const std::vector<std::vector<int>> nodes = nodes_of(elements, from);
  ForceStep step{begin, end, velocities};
  step.duration = kAtOnce;
  for (std::size_t k = 0; k < elements.size(); ++k) {
    step.memory = memories[k];
    if (elements[k]->hits() && elements[k]->needs_halves(step, nodes[k].data(), static_cast<int>(nodes[k].size())))
      return true;
  }
  return false;
}

}  // namespace flexarm
