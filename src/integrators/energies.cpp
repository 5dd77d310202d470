#include "integrators/energies.h"

#include <cassert>

#include "elements/conserving_terms.h"
#include "elements/element_configuration.h"
#include "joints/elasticity.h"
#include "joints/joint_stop.h"

namespace flexarm {
namespace {

Matrix3 lumped_rotary(const NodalInertia& inertia, const Scheme& scheme) {
  return scheme.nodal_rotary_inertia ? Matrix3(inertia.rotary + inertia.beam_rotary) : inertia.rotary;
}

/// Energy that is stored in the memory of numerical dissipation and dampers at a stiffness point [J/m].
template <int Nodes>
double stored(const TimeRule& rule, const StrainMemory& memory, const BeamElement<Nodes>& element, int point) {
  const Matrix6& stiffness = element.stiffness_points[point].stiffness;
  const auto square = [&](const Vector6& strain) { return strain.dot(stiffness * strain); };
  const NumericalDissipation& d = rule.dissipation;
  const conserving::DamperParts<double> damper(element.stiffness_damping, rule.damping_relaxation);
  const Vector6 damped = element.damping_scale.cwiseProduct(memory.rate),
                delayed = element.damping_scale.cwiseProduct(memory.delayed_rate);
  double energy = 0.5 * (d.inertance * square(memory.rate) + damper.inertance * square(damped) +
                         damper.inertance * square(delayed));
  if (d.forgetting > 0) energy += 0.5 * d.stiffness / d.forgetting * square(memory.average);
  return energy;
}

}  // namespace

Energies energies(const Model& model, const Scheme& scheme, const State& state) {
  assert(state.nodes.size() == model.nodes.size() && state.released.size() == model.joints.size_with_held());
  assert(state.actuators.size() == model.actuators.size());
  Energies out;
  out.work = state.work;
  out.dissipated = state.dissipated;
  for_each_element(model.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const ElementConfiguration<N> nodes(element, state);
    const LocalRotations<N> local(nodes.orientation);
    const Vector6 prestrain = prestrain_at(model, element.prestrain, state.time);
    for (int k = 0; k < N - 1; ++k) {
      const auto& point = element.stiffness_points[k];
      const double weight = point.weight;
      const Vector6 strain = centroid_strain(element, nodes, local, state, k) - prestrain;
      out.strain += 0.5 * weight * strain.dot(point.stiffness * strain);
      const Vector6* branch = branch_strains(model, state, element.first_stiffness_point + k);
      for (const MaxwellBranch& maxwell : element.maxwell) {
        out.strain += 0.5 * weight * maxwell.modulus_ratio * branch->dot(point.stiffness * *branch);
        ++branch;
      }
      if (!state.strain_memory.empty())
        out.strain += weight * stored(scheme, state.strain_memory[element.first_stiffness_point + k], element, k);
    }
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) out.kinetic += 0.5 * element.mass(i, j) * nodes.velocity[i].dot(nodes.velocity[j]);
    for (int k = 0; k < N && !scheme.nodal_rotary_inertia; ++k) {
      const Vector3& W = state.study.mass_points[element.first_mass_point + k].angular_velocity;
      out.kinetic += 0.5 * element.mass_points[k].weight * W.dot(element.mass_points[k].inertia * W);
    }
  });
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    const NodeState& node = state.nodes[i];
    out.kinetic += 0.5 * inertia.mass * node.velocity.squaredNorm() +
                   0.5 * node.angular_velocity.dot(lumped_rotary(inertia, scheme) * node.angular_velocity);
    out.potential -= inertia.total_mass * model.gravity.dot(node.position + (state.origin - model.initial_origin));
  }
  const double* memory = state.force_memory.data();
  for (const auto& element : model.force_elements) {
    out.strain += element->energy(state, memory);
    memory += element->memory_size();
  }
  for (const Coordinate& coordinate : model.coordinates)
    if (coordinate.limit)
      out.strain += stop_energy(*coordinate.limit, state.released[coordinate.joint].displacement[coordinate.component]);
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const Actuator& actuator = model.actuators[i];
    const Coordinate& coordinate = model.coordinates[actuator.coordinate];
    const double position = state.released[coordinate.joint].displacement[coordinate.component % 3];
    const ActuatorState& rotor = state.actuators[i];
    out.kinetic += 0.5 * actuator.drive.inertia * rotor.rate * rotor.rate;
    if (actuator.drive.gear) out.strain += elastic_energy(*actuator.drive.gear, rotor.angle - position);
    if (actuator.spring) out.strain += elastic_energy(actuator.spring->elasticity, position - actuator.spring->rest);
  }
  return out;
}

Momenta momenta(const Model& model, const Scheme& scheme, const State& state) {
  assert(state.nodes.size() == model.nodes.size() && state.actuators.size() == model.actuators.size());
  Momenta out;
  for_each_element(model.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const ElementConfiguration<N> nodes(element, state);
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) {
        out.linear += element.mass(i, j) * nodes.velocity[j];
        out.angular += element.mass(i, j) * nodes.position[i].cross(nodes.velocity[j]);
      }
    if (scheme.nodal_rotary_inertia) return;
    const LocalRotations<N> local(nodes.orientation);
    for (int k = 0; k < N; ++k) {
      const auto& point = element.mass_points[k];
      const int index = element.first_mass_point + k;
      const Vector3& W = state.study.mass_points[index].angular_velocity;
      out.angular += point.weight *
                     (point_rotation(local, point, state.study.mass_rotations, index).rotation * (point.inertia * W));
    }
  });
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    const NodeState& node = state.nodes[i];
    out.linear += inertia.mass * node.velocity;
    out.angular += inertia.mass * node.position.cross(node.velocity) +
                   node.orientation * (lumped_rotary(inertia, scheme) * node.angular_velocity);
  }
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    if (!model.actuators[i].gyroscope) continue;
    const auto& [node, axis, inertia, ratio] = *model.actuators[i].gyroscope;
    out.angular += inertia * ratio * state.actuators[i].rate * (state.nodes[node].orientation * axis);
  }
  return out;
}

}  // namespace flexarm
