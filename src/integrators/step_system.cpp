#include "flexarm/integrators/step_system.h"

#include <algorithm>
#include <cmath>

#include "flexarm/elements/conserving_beam.h"
#include "flexarm/elements/load.h"
#include "flexarm/elements/nodal_inertia.h"
#include "flexarm/elements/rotary_inertia.h"
#include "flexarm/joints/joint_forces.h"
#include "flexarm/math/cayley.h"
#include "flexarm/math/so3.h"

namespace flexarm {

StepSystem::StepSystem(const Model& model, const Scheme& scheme)
    : model_(model),
      scheme_(scheme),
      dof_(model),
      assembler_(model, dof_),
      begin_(model.nodes),
      end_(model.nodes),
      released_(model.initial_released),
      increments_(model.nodes.size(), Vector3::Zero()),
      inverse_tangents_(model.nodes.size(), Matrix3::Identity()),
      begin_points_(model.stiffness_point_count),
      end_points_(model.stiffness_point_count),
      begin_mass_rotations_(model.mass_point_count),
      end_mass_rotations_(model.mass_point_count),
      end_mass_points_(model.mass_point_count),
      end_strain_rates_(model.stiffness_point_count, Vector6::Zero()),
      history_values_(model.histories.size()),
      begin_history_values_(model.histories.size()),
      applied_(model.coordinates.size(), 0.0),
      begin_rates_(model.joints.size()),
      residual_(Eigen::VectorXd::Zero(dof_.unknowns)) {
  for_each_group(model.beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group.elements)>::value_type::kNodes;
    std::get<GroupFunctions<N>>(mid_functions_).resize(group.elements.size());
  });
}

template <int Nodes>
void StepSystem::gather_nodes(const BeamElement<Nodes>& element, ElementNodes<Nodes>& nodes) const {
  for (int i = 0; i < Nodes; ++i) {
    const int node = element.nodes[i];
    nodes.begin[i] = begin_[node].position;
    nodes.end[i] = end_[node].position;
    nodes.orientation[i] = end_[node].orientation;
    nodes.increment[i] = increments_[node];
    nodes.increment_inverse_tangent[i] = inverse_tangents_[node];
    nodes.velocity[i] = state_->nodes[node].velocity;
    nodes.acceleration[i] = state_->nodes[node].acceleration;
  }
}

template <int Nodes>
void StepSystem::scatter(const BeamElement<Nodes>& element, const ElementSystem<Nodes>& system, bool with_tangent) {
  dissipated_ += system.dissipated;
  for (int i = 0; i < Nodes; ++i) {
    Eigen::Map<Vector6>(assembler_.residual(element.nodes[i])) += system.residual.template segment<6>(6 * i);
    for (int j = 0; j < Nodes && with_tangent; ++j)
      Eigen::Map<Matrix6>(assembler_.element_block(element.first_block + i * Nodes + j)) +=
          system.tangent.template block<6, 6>(6 * i, 6 * j);
  }
}

template <int Nodes>
void StepSystem::add_rotary(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, bool with_tangent,
                            ElementSystem<Nodes>& system) {
  const int first = element.first_mass_point;
  const auto rate = [&](int k, const Matrix3& begin, const Matrix3& end) {
    const MassPointState& state = state_->mass_points[first + k];
    RotaryRate r;
    if (scheme_.is_incremental()) {
      const Vector3 increment = so3::log(Matrix3(end * begin.transpose()));
      r = average_rotary_rate(element.inertia, begin, end, increment, so3::inverse_tangent(increment), state, step_);
    } else {
      r = newmark_rotary_rate(element.inertia, begin, end, state, {scheme_.beta, scheme_.gamma, step_});
    }
    end_mass_points_[first + k] = r.end;
    return r;
  };
  add_rotary_inertia<Nodes>(element, nodes, &begin_mass_rotations_[first], rate, with_tangent,
                            &end_mass_rotations_[first], system);
}

template <class Stress>
void StepSystem::add_conserving_beams(bool with_tangent) {
  for_each_group(model_.beams, [&](const auto& group) {
    constexpr int N = std::decay_t<decltype(group.elements)>::value_type::kNodes;
    const GroupFunctions<N>& functions = std::get<GroupFunctions<N>>(mid_functions_);
    ElementNodes<N> nodes;
    ElementSystem<N> system;
    for (std::size_t e = 0; e < group.elements.size(); ++e) {
      const BeamElement<N>& element = group.elements[e];
      gather_nodes(element, nodes);
      conserving_beam<Stress, N>(element, nodes, functions[e], &begin_points_[element.first_stiffness_point], step_,
                                 with_tangent, &end_points_[element.first_stiffness_point], system);
      if (!scheme_.nodal_rotary_inertia) add_rotary(element, nodes, with_tangent, system);
      scatter(element, system, with_tangent);
    }
  });
}

void StepSystem::add_endpoint_beams(bool with_tangent) {
  const NewmarkRule rule{scheme_.beta, scheme_.gamma, step_};
  for_each_element(model_.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const int first = element.first_stiffness_point;
    ElementNodes<N> nodes;
    ElementSystem<N> system;
    system.set_zero();
    gather_nodes(element, nodes);
    endpoint_internal<N>(element, nodes, static_ ? nullptr : &rule, &begin_points_[first],
                         state_->strain_rates.data() + first, with_tangent, &end_points_[first],
                         &end_strain_rates_[first], system);
    if (!static_) {
      newmark_translation<N>(element, nodes, rule, with_tangent, system);
      add_rotary(element, nodes, with_tangent, system);
    }
    scatter(element, system, with_tangent);
  });
}

void StepSystem::add_nodal_inertia(bool with_tangent) {
  for (std::size_t i = 0; i < end_.size(); ++i) {
    const NodalInertia& inertia = model_.inertias[i];
    Eigen::Map<Vector6> residual(assembler_.residual(static_cast<int>(i)));
    residual.head<3>() -= load_factor_ * inertia.total_mass * model_.gravity;
    if (static_ || inertia.empty()) continue;
    const NodalInertiaAction action = nodal_inertia_action(
        inertia, scheme_, {begin_[i], end_[i], state_->nodes[i], increments_[i], inverse_tangents_[i], step_},
        with_tangent);
    residual += action.residual;
    dissipated_ += action.dissipated;
    if (!with_tangent) continue;
    Eigen::Map<Matrix6> tangent(assembler_.diagonal_block(static_cast<int>(i)));
    tangent.topLeftCorner<3, 3>().diagonal().array() += action.translational;
    tangent.bottomRightCorner<3, 3>() += action.rotational;
  }
}

void StepSystem::add_loads(bool with_tangent) {
  const LoadPoint point = static_ || !scheme_.is_incremental() ? LoadPoint::End : LoadPoint::Mean;
  for (const NodalLoad& load : model_.loads) {
    const LoadAction action = load_action(load, load_factor_ * history_values_[load.history],
                                          begin_[load.node].rotation, end_[load.node].rotation, point);
    Eigen::Map<Vector6>(assembler_.residual(load.node)) -= action.wrench;
    if (with_tangent) Eigen::Map<Matrix6>(assembler_.diagonal_block(load.node)).rightCols<3>() -= action.derivative;
  }
}

double StepSystem::effort_at(const Coordinate& coordinate, std::size_t index) const {
  const double commanded = state_->commands[index];
  double effort = 0;
  if (!std::isnan(commanded))
    effort = commanded;
  else if (coordinate.effort >= 0)
    effort = history_values_[coordinate.effort];
  if (coordinate.effort_limit > 0) effort = std::clamp(effort, -coordinate.effort_limit, coordinate.effort_limit);
  return load_factor_ * effort;
}

void StepSystem::add_joint_efforts(int j, bool with_tangent) {
  const JointMap& joint = model_.joints[j];
  const int count = released_count(joint.kind), variable = dof_.variable_of_joint(j);
  if (count == 0) return;
  double* residual = assembler_.residual(variable);
  Eigen::Map<ReleasedSquare> tangent(assembler_.diagonal_block(variable), count, count);
  ReleasedVector change = ReleasedVector::Zero(count);
  if (!static_) change = released_increment(joint, state_->released[j], released_[j]);
  const bool incremental = scheme_.is_incremental();
  for (int k = 0; k < count; ++k) {
    const std::size_t index = model_.first_coordinate[j] + k;
    const Coordinate& coordinate = model_.coordinates[index];
    CoordinateStep step;
    step.begin = state_->released[j].displacement[k % 3];
    step.end = released_[j].displacement[k % 3];
    step.increment = change[k];
    step.step = step_;
    if (!incremental) step.gamma = scheme_.gamma, step.begin_rate = static_ ? 0.0 : begin_rates_[j][k];
    const PassiveEffort passive = passive_effort(coordinate, step);
    dissipated_ += passive.dissipated;
    applied_[index] = effort_at(coordinate, index);
    residual[k] -= applied_[index] + passive.effort;
    if (!with_tangent || passive.slope == 0) continue;
    if (coordinate.is_angle) {  // the increment varies as S^{-1} spin
      const Vector3 rotation = change.tail<3>();
      tangent.row(k).tail<3>() -= passive.slope * cayley::inverse_tangent(rotation).row(k - (count - 3));
    } else {
      tangent(k, k) -= passive.slope;
    }
  }
}

void StepSystem::fold_joints(bool with_tangent) {
  const NodePose world;
  FoldMaps maps;
  for (int j = static_cast<int>(model_.joints.size()) - 1; j >= 0; --j) {
    const JointMap& joint = model_.joints[j];
    const Vector6 g = assembler_.slave_residual(joint.slave);
    const NodePose& end = joint.master < 0 ? world : end_[joint.master];
    if (!static_ && scheme_.is_incremental())
      incremental_maps(joint, joint.master < 0 ? world : begin_[joint.master], end, state_->released[j], released_[j],
                       g, maps, with_tangent);
    else
      variational_maps(joint, end, released_[j], g, maps);
    assembler_.fold(j, maps, with_tangent);
    add_joint_efforts(j, with_tangent);
  }
  assembler_.fold_mimics(with_tangent);
}

bool StepSystem::evaluate(bool with_tangent) {
  assembler_.set_zero(with_tangent);
  dissipated_ = 0;
  if (with_tangent && !static_)
    for (std::size_t i = 0; i < increments_.size(); ++i) inverse_tangents_[i] = cayley::inverse_tangent(increments_[i]);
  if (static_)
    add_endpoint_beams(with_tangent);
  else
    switch (scheme_.stress) {
      case StressRule::EndPoint:
        add_endpoint_beams(with_tangent);
        break;
      case StressRule::Average:
        add_conserving_beams<AverageStress>(with_tangent);
        break;
      case StressRule::DiscreteGradient:
        add_conserving_beams<DiscreteGradientStress>(with_tangent);
        break;
      case StressRule::Exponential:
        add_conserving_beams<ExponentialMoment>(with_tangent);
        break;
    }
  add_nodal_inertia(with_tangent);
  add_loads(with_tangent);
  fold_joints(with_tangent);
  assembler_.gather(residual_);
  if (with_tangent) assembler_.gather_tangent();
  return residual_.allFinite();
}

}  // namespace flexarm
