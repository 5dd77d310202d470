#include "study_schemes/integration_points.h"

#include <algorithm>
#include <cassert>

#include "math/cayley.h"

namespace flexarm {

IntegrationPoints::IntegrationPoints(const StepConfiguration& configuration, const StepPrestrains& prestrains)
    : reference(configuration.model(), configuration.scheme()),
      inverse_tangents(configuration.model().nodes.size(), Matrix3::Identity()),
      begin_stiffness(configuration.model().stiffness_point_count),
      end_stiffness(configuration.model().stiffness_point_count),
      begin_rotations(configuration.model().mass_point_count),
      end_rotations(configuration.model().mass_point_count),
      end_motion(configuration.model().mass_point_count),
      configuration_(configuration),
      prestrains_(prestrains),
      carried_strains_(configuration.model().stiffness_point_count) {}

void IntegrationPoints::set_inverse_tangents() {
  for (std::size_t i = 0; i < inverse_tangents.size(); ++i)
    inverse_tangents[i] = cayley::inverse_tangent(configuration_.increments()[i]);
}

void IntegrationPoints::begin(bool carries) {
  reference.begin(configuration_.state());
  if (!hold_) set_begin_points();
  hold_ = true;
  carries_ = holds_carried_ = carries && !carried_strains_.empty();
  for (std::size_t k = 0; k < carried_strains_.size(); ++k) carried_strains_[k] = begin_stiffness[k].strain;
}

void IntegrationPoints::carry_strains(const std::vector<NodePose>& end, const double* update) {
  if (!carries_) return;
  assert(update && end.size() == configuration_.end().size());
  holds_carried_ = true;
  for_each_element(configuration_.model().beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    ElementNodes<N> nodes;
    gather(element, end, nodes);
    std::array<Vector6, N> moved;
    for (int i = 0; i < N; ++i) moved[i] = Eigen::Map<const Vector6>(update + 6 * element.nodes[i]);
    flexarm::carry_strains<N>(element, nodes, moved, &carried_strains_[element.first_stiffness_point]);
  });
}

void IntegrationPoints::set_begin_points() {
  const State& state = configuration_.state();
  for_each_element(configuration_.model().beams, [&](const auto& element) {
    using Element = std::decay_t<decltype(element)>;
    constexpr int N = Element::kNodes;
    std::array<Quaternion, N> orientation;
    std::array<Vector3, N> position;
    for (int i = 0; i < N; ++i) {
      orientation[i] = configuration_.begin()[element.nodes[i]].orientation;
      position[i] = configuration_.begin()[element.nodes[i]].position;
    }
    const LocalRotations<N> local(orientation);
    for (int k = 0; k < Element::kStiffnessPoints; ++k) {
      const auto& point = element.stiffness_points[k];
      const int index = element.first_stiffness_point + k;
      begin_stiffness[index] = point_kinematics(
          reference.is_used() ? state.study.stiffness_rotations[index] : local.evaluate(point.shape, point.derivative),
          interpolate<N>(point.derivative, position), point.reference_strain);
      begin_stiffness[index].strain -= prestrains_.of_step(element.prestrain);
    }
    for (int k = 0; k < Element::kMassPoints; ++k) {
      const auto& point = element.mass_points[k];
      const int index = element.first_mass_point + k;
      begin_rotations[index] = reference.is_used() ? state.study.mass_rotations[index].rotation
                                                   : local.evaluate(point.shape, point.derivative).rotation;
    }
  });
}

double IntegrationPoints::work_of_prestrains() const {
  double work = 0;
  for_each_element(configuration_.model().beams, [&](const auto& element) {
    for (int k = 0; k < std::decay_t<decltype(element)>::kStiffnessPoints; ++k) {
      const int index = element.first_stiffness_point + k;
      work += prestrains_.work(element, k, begin_stiffness[index].strain, end_stiffness[index].strain);
    }
  });
  return work;
}

void IntegrationPoints::accept(State& state) {
  reference.accept(state);
  std::swap(begin_stiffness, end_stiffness);
  std::swap(begin_rotations, end_rotations);
}

}  // namespace flexarm
