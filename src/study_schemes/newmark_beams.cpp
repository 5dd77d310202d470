#include "study_schemes/newmark_beams.h"

#include <algorithm>

#include "elements/node_motion.h"
#include "integrators/nodal_forces.h"
#include "integrators/step_system.h"
#include "study_schemes/additive_beam.h"
#include "study_schemes/newmark_beam.h"

namespace flexarm {

NewmarkBeams::NewmarkBeams(const StepConfiguration& configuration, const StepPrestrains& prestrains)
    : configuration_(configuration),
      points_(configuration, prestrains),
      bodies_(configuration, points_),
      end_strain_rates_(configuration.model().stiffness_point_count, Vector6::Zero()),
      end_momentum_rates_(configuration.model().mass_point_count, Vector3::Zero()) {
  if (configuration.scheme().hht != HhtForm::None && !is_static())
    interpolation_ = std::make_unique<HhtInterpolation>(configuration, points_.reference.total_rotations());
}

void NewmarkBeams::begin() {
  const Scheme& scheme = configuration_.scheme();
  rule_ = newmark_rule(scheme, configuration_.step());
  if (is_static()) points_.invalidate();
  points_.begin(may_carry());
}

void NewmarkBeams::add_forces(Balance& balance) {
  const std::vector<NodePose>& end = interpolation_ ? interpolation_->configuration() : configuration_.end();
  const bool with_tangent = balance.tangent;
  if (interpolation_) interpolation_->begin_evaluation();
  points_.reference.set_trial(end);
  for_each_element(configuration_.model().beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const int first = element.first_stiffness_point;
    ElementNodes<N> nodes;
    ElementSystem<N> system;
    system.set_zero();
    points_.gather(element, end, nodes);
    const auto internal = is_additive()                                ? endpoint_internal<N, AdditiveForm>
                          : configuration_.scheme().tests_vary_strains ? endpoint_internal<N, VariationForm>
                                                                       : endpoint_internal<N, SpinForm>;
    internal(element, nodes, is_static() ? nullptr : &rule_, &points_.begin_stiffness[first],
             configuration_.state().study.strain_rates.data() + first, with_tangent, &points_.end_stiffness[first],
             &end_strain_rates_[first], system, points_.carried(first, balance));
    if (is_additive()) additive_to_spins(nodes, with_tangent, system);
    if (!is_static() && !interpolates_kinematics())
      newmark_mass_damping<N>(element, nodes, rule_, with_tangent, system);
    if (interpolation_) interpolation_->take(element, with_tangent, system);
    balance.add(element, system, true);
  });
  if (with_tangent) points_.drop_carried();
  if (is_static()) return;
  bodies_.for_each_damping(with_tangent, [&](int node, const NodalAction& damping) {
    Eigen::Matrix<double, 6, 3> rotational = Eigen::Matrix<double, 6, 3>::Zero();
    rotational.bottomRows<3>() = damping.rotational;
    add_nodal(node, damping.residual, rotational, false, balance);
    balance.dissipated += damping.dissipated;
  });
}

void NewmarkBeams::add_nodal(int node, const Vector6& force, Eigen::Matrix<double, 6, 3> rotational,
                             bool of_configuration, Balance& balance) {
  const bool with_tangent = balance.tangent;
  if (interpolation_)
    interpolation_->take(node, force, rotational, of_configuration, with_tangent);
  else
    balance.residual.node(node) += force;
  if (!with_tangent) return;
  Matrix6 tangent = Matrix6::Zero();
  tangent.rightCols<3>() = rotational;
  balance.tangent->add_to_node(node, tangent);
}

/// Wrenches with a spring are refused where forces are interpolated.
void NewmarkBeams::add_loads(const NodalForces& loads, Balance& balance) {
  if (!interpolation_) return loads.evaluate(balance);
  loads.for_each_weight([&](int node, const Vector3& weight) { interpolation_->take(node, Vector3(-weight)); });
  loads.for_each_action(interpolation_->configuration(), [&](int node, const LoadAction& action) {
    add_nodal(node, -action.wrench, -action.derivative, true, balance);
  });
}

void NewmarkBeams::initialise(State& state) {
  points_.reference.initialise(state);
  if (!interpolation_) return;
  const Model& model = configuration_.model();
  std::vector<Vector3>& rates = state.study.momentum_rates;
  rates.assign(model.mass_point_count + model.nodes.size(), Vector3::Zero());
  points_.invalidate();
  points_.begin(false);
  for_each_element(model.beams, [&](const auto& element) {
    for (std::size_t k = 0; k < element.mass_points.size(); ++k) {
      const int index = element.first_mass_point + static_cast<int>(k);
      const MassPointState& point = state.study.mass_points[index];
      rates[index] = momentum_rate(points_.begin_rotations[index], element.mass_points[k].inertia,
                                   point.angular_velocity, point.angular_acceleration);
    }
  });
  points_.invalidate();
  bodies_.initialise(state);
  state.study.forces = StepSystem(model, statics_of(configuration_.scheme())).nodal_forces(state);
}

template <int Nodes>
void NewmarkBeams::add_rotary(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, bool with_tangent,
                              ElementSystem<Nodes>& system) {
  const int first = element.first_mass_point;
  const State& before = configuration_.state();
  for_each_mass_point(element, nodes, with_tangent,
                      [&](int k, const PointRotation& point, const GeneralisedShapeFunctions<Nodes>& generalised) {
                        const MassPointState& state = before.study.mass_points[first + k];
                        const Matrix3& begin = points_.begin_rotations[first + k];
                        const Matrix3& inertia = element.mass_points[k].inertia;
                        const RotaryRate rate =
                            interpolation_ ? momentum_rotary_rate(inertia, begin, point.rotation, state,
                                                                  before.study.momentum_rates[first + k], rule_)
                                           : newmark_rotary_rate(inertia, begin, point.rotation, state, rule_);
                        points_.end_rotations[first + k] = point.rotation;
                        points_.end_motion[first + k] = rate.end;
                        end_momentum_rates_[first + k] = rate.moment;
                        if (is_additive())
                          add_additive_rotary_rate(element, nodes, k, rate, with_tangent, system);
                        else
                          add_rotary_rate(element, k, rate, generalised, with_tangent, system);
                      });
}

void NewmarkBeams::add_inertia(Balance& balance) {
  if (interpolation_) interpolation_->add_forces(balance);
  bodies_.add_inertia(balance);
  add_element_inertia(balance);
  if (interpolation_) interpolation_->shift_reactions(balance);
}

void NewmarkBeams::add_element_inertia(Balance& balance) {
  const bool with_tangent = balance.tangent;
  if (interpolates_kinematics()) points_.reference.set_trial(configuration_.end());
  for_each_element(configuration_.model().beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    ElementNodes<N> nodes;
    ElementSystem<N> system;
    system.set_zero();
    points_.gather(element, configuration_.end(), nodes);
    add_rotary(element, nodes, with_tangent, system);
    if (is_additive()) additive_to_spins(nodes, with_tangent, system);
    newmark_translation<N>(element, nodes, rule_, with_tangent, system);
    if (interpolates_kinematics()) newmark_mass_damping<N>(element, nodes, rule_, with_tangent, system);
    balance.add(element, system, false);
  });
}

NodeState NewmarkBeams::motion_at_end(int node) const {
  return is_static() ? at_rest(configuration_.end()[node]) : bodies_.motion_at_end(node);
}

void NewmarkBeams::accept(State& state) {
  if (is_static()) {
    for (std::size_t i = 0; i < state.nodes.size(); ++i) state.nodes[i] = at_rest(configuration_.end()[i]);
  } else {
    bodies_.accept(state);
    std::copy(points_.end_motion.begin(), points_.end_motion.end(), state.study.mass_points.begin());
    std::copy(end_strain_rates_.begin(), end_strain_rates_.end(), state.study.strain_rates.begin());
  }
  points_.accept(state);
  if (!interpolation_) return;
  std::copy(end_momentum_rates_.begin(), end_momentum_rates_.end(), state.study.momentum_rates.begin());
  interpolation_->accept(state);
  if (interpolates_kinematics()) points_.invalidate();  // the present points belong to t_{n+1+alpha}
}

}  // namespace flexarm
