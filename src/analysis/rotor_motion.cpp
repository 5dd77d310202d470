#include "analysis/rotor_motion.h"

#include <Eigen/SparseCore>

#include "joints/elasticity.h"
#include "joints/motor_step.h"

namespace flexarm {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Of a spring of the tangent stiffness k between the coordinate and its rotor, and a servo on one of both.
struct Coupling {
  double gear, on_rotor, on_link;
};

/// Between equations `q` and `rotor`.
void add(const Coupling& coupling, int q, int rotor, Triplets& entries) {
  entries.emplace_back(q, q, coupling.gear);
  entries.emplace_back(q, rotor, -coupling.gear);
  entries.emplace_back(rotor, q, coupling.on_link - coupling.gear);
  entries.emplace_back(rotor, rotor, coupling.gear + coupling.on_rotor);
}

/// Of the controller in force; null where none is, or it is off.
const ServoLaw* law_in_force(const Actuator& actuator, const ActuatorState& state) {
  return actuator.servo && state.servo.off == 0 ? &law_of(*actuator.servo, state.servo) : nullptr;
}

/// Side of a servo on which a gain acts.
Coupling coupling(double gear, const std::optional<Servo>& servo, double gain) {
  if (!servo) return {gear, 0, 0};
  return servo->on_link ? Coupling{gear, 0, gain} : Coupling{gear, gain, 0};
}

std::vector<double> values(const Sparse& pattern, const SparseTangent& own, const Triplets& added) {
  Sparse sum(pattern.rows(), pattern.cols());
  Triplets entries = added;
  for (int column = 0; column < own.unknowns(); ++column)
    for (int p = own.column_starts()[column]; p < own.column_starts()[column + 1]; ++p)
      entries.emplace_back(own.row_indices()[p], column, own.values()[p]);
  sum.setFromTriplets(entries.begin(), entries.end());
  const Sparse whole = sum + pattern;  // pattern holds zeros: all entries are there
  return {whole.valuePtr(), whole.valuePtr() + whole.nonZeros()};
}

}  // namespace

std::vector<ActuatorTerms> actuator_terms(const Model& model, const State& state) {
  std::vector<ActuatorTerms> terms;
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const Actuator& actuator = model.actuators[i];
    const Coordinate& coordinate = model.coordinates[actuator.coordinate];
    const double spring = actuator.spring ? actuator.spring->elasticity.damping : 0;
    const ServoLaw* law = law_in_force(actuator, state.actuators[i]);
    const double servo = law && !actuator.drive.gear ? law->derivative : 0;
    terms.push_back({coordinate.joint, coordinate.component, spring + servo, armature(model, coordinate)});
  }
  return terms;
}

RotorEntries rotor_entries(const Model& model, const DegreesOfFreedom& dof, const State& state,
                           const Actuators& resting, int first) {
  RotorEntries entries;
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const Actuator& actuator = model.actuators[i];
    const Coordinate& coordinate = model.coordinates[actuator.coordinate];
    const int q = dof.equation[dof.scalar_of(coordinate)];
    if (!actuator.drive.gear || q < 0) continue;
    const int rotor = first + static_cast<int>(entries.actuators.size());
    const double position = state.released[coordinate.joint].displacement[coordinate.component % 3];
    CoordinateStep twist;
    twist.begin = twist.end = state.actuators[i].angle - position;
    const Elasticity& gear = *actuator.drive.gear;
    const ServoLaw* law = law_in_force(actuator, state.actuators[i]);
    const bool holds = law && law->mode == ServoMode::Position;
    add(coupling(-elastic_effort(gear, twist).slope, actuator.servo, holds ? law->proportional : 0), q, rotor,
        entries.stiffness);
    entries.stiffness.emplace_back(q, q, -resting.stiffness(i));
    add(coupling(elastic_damping(gear, twist.end), actuator.servo, law ? law->derivative : 0), q, rotor,
        entries.damping);
    entries.mass.emplace_back(rotor, rotor, actuator.drive.inertia);
    entries.actuators.push_back(static_cast<int>(i));
  }
  return entries;
}

MotionMatrices with_rotors(const Model& model, const DegreesOfFreedom& dof, const State& state,
                           const Actuators& resting, const SparseTangent& stiffness, const SparseTangent& damping,
                           const SparseTangent& mass) {
  const RotorEntries rotors = rotor_entries(model, dof, state, resting, stiffness.unknowns());
  if (rotors.actuators.empty()) return {};
  const int size = stiffness.unknowns() + static_cast<int>(rotors.actuators.size());
  Triplets places;
  // Springs couple all four places of a coordinate and its rotor.
  for (const Eigen::Triplet<double>& entry : rotors.stiffness) places.emplace_back(entry.row(), entry.col(), 0.0);
  for (int column = 0; column < stiffness.unknowns(); ++column)
    for (int p = stiffness.column_starts()[column]; p < stiffness.column_starts()[column + 1]; ++p)
      places.emplace_back(stiffness.row_indices()[p], column, 0.0);
  Sparse pattern(size, size);
  pattern.setFromTriplets(places.begin(), places.end());
  MotionMatrices out;
  out.column_starts.assign(pattern.outerIndexPtr(), pattern.outerIndexPtr() + size + 1);
  out.row_indices.assign(pattern.innerIndexPtr(), pattern.innerIndexPtr() + pattern.nonZeros());
  out.stiffness = values(pattern, stiffness, rotors.stiffness);
  out.damping = values(pattern, damping, rotors.damping);
  out.mass = values(pattern, mass, rotors.mass);
  return out;
}

}  // namespace flexarm
