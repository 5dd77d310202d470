#include "integrators/static_beams.h"

#include <cassert>

namespace flexarm {

StaticBeams::StaticBeams(const StepConfiguration& configuration, const StepPrestrains& prestrains)
    : configuration_(configuration), prestrains_(prestrains), carried_(configuration.model().stiffness_point_count) {}

template <class Visit>
void StaticBeams::for_each(const std::vector<NodePose>& poses, const Visit& visit) const {
  for_each_element(configuration_.model().beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    PlacedNodes<N> nodes;
    for (int i = 0; i < N; ++i) {
      nodes.end[i] = poses[element.nodes[i]].position;
      nodes.orientation[i] = poses[element.nodes[i]].orientation;
    }
    nodes.prestrain = prestrains_.of_step(element.prestrain);
    visit(element, nodes);
  });
}

void StaticBeams::begin() {
  carries_strains_ = !carried_.empty();
  for_each(configuration_.begin(), [&](const auto& element, const auto& nodes) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const LocalRotationAt<N> rotation_at(element, nodes, false);
    GeneralisedShapeFunctions<N> unused;
    for (int k = 0; k < BeamElement<N>::kStiffnessPoints; ++k)
      carried_[element.first_stiffness_point + k] =
          end_kinematics<N>(element.stiffness_points[k], nodes, rotation_at(k, unused)).strain;
  });
}

void StaticBeams::add_forces(Balance& balance) {
  for_each(configuration_.end(), [&](const auto& element, const auto& nodes) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const auto add =
        configuration_.scheme().tests_vary_strains ? static_beam<N, VariationForm> : static_beam<N, SpinForm>;
    const int first = element.first_stiffness_point;
    std::array<PointKinematics, BeamElement<N>::kStiffnessPoints> points;
    ElementSystem<N> system;
    system.set_zero();
    add(element, nodes, balance.tangent != nullptr, points.data(), system,
        balance.carried ? &carried_[first] : nullptr);
    balance.add(element, system, true);
  });
  if (balance.tangent) carries_strains_ = false;
}

void StaticBeams::carry_strains(const double* update) {
  assert(update);
  carries_strains_ = !carried_.empty();
  for_each(configuration_.end(), [&](const auto& element, const auto& nodes) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    std::array<Vector6, N> moved;
    for (int i = 0; i < N; ++i) moved[i] = Eigen::Map<const Vector6>(update + 6 * element.nodes[i]);
    carried_strains<N>(element, nodes, LocalRotationAt<N>(element, nodes, true), moved,
                       &carried_[element.first_stiffness_point]);
  });
}

void StaticBeams::accept(State& state) {
  for (std::size_t i = 0; i < state.nodes.size(); ++i) state.nodes[i] = at_rest(configuration_.end()[i]);
}

}  // namespace flexarm
