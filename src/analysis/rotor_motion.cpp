#include "analysis/rotor_motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/SparseCore>

#include "integrators/step_histories.h"
#include "joints/elasticity.h"
#include "joints/motor_step.h"
#include "joints/set_points.h"

namespace flexarm {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Coefficients for a coordinate and its rotor: of the elastic gear between them, and of a servo on the rotor or on the
/// link.
struct Coupling {
  double gear, on_rotor, on_link;
};

/// Adds a coupling between the equations `q` and `rotor`.
void add(const Coupling& coupling, int q, int rotor, Triplets& entries) {
  entries.emplace_back(q, q, coupling.gear);
  entries.emplace_back(q, rotor, -coupling.gear);
  entries.emplace_back(rotor, q, coupling.on_link - coupling.gear);
  entries.emplace_back(rotor, rotor, coupling.gear + coupling.on_rotor);
}

/// The law of the active controller; null if there is none, or if it is off.
const ServoLaw* law_in_force(const Actuator& actuator, const ActuatorState& state) {
  return actuator.servo && state.servo.off == 0 ? &law_of(*actuator.servo, state.servo) : nullptr;
}

/// Equation of the coordinate that an actuator drives.
int equation_of(const Model& model, const DegreesOfFreedom& dof, std::size_t actuator) {
  return dof.equation[dof.scalar_of(model.coordinates[model.actuators[actuator].coordinate])];
}

/// Twist of an elastic gear [rad or m].
double gear_twist(const Model& model, const State& state, std::size_t actuator) {
  const Coordinate& coordinate = model.coordinates[model.actuators[actuator].coordinate];
  return state.actuators[actuator].angle - state.released[coordinate.joint].displacement[coordinate.component % 3];
}

/// The coupling by a gear, and by a gain of the servo on the side that it measures.
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
  const Sparse whole = sum + pattern;  // `pattern` holds zeros, so that all of its entries exist
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
    terms.push_back({coordinate.joint, coordinate.component, spring, armature(model, coordinate), servo});
  }
  return terms;
}

void command_by_rates(const Model& model, const ActuatorRates& rates, Model& frozen, State& state) {
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const Actuator& actuator = model.actuators[i];
    const std::size_t c = actuator.coordinate;
    const ServoLaw* law = law_in_force(actuator, state.actuators[i]);
    if (!law || model.coordinates[c].motion >= 0) continue;
    const Servo& servo = *actuator.servo;
    ServoState& own = state.actuators[i].servo;
    const double set_point = set_point_at(model, servo, own, state.time);
    const double set_rate = set_rate_at(model, servo, own, state.time);
    if (!std::isnan(own.set_point)) own.set_point = set_point;
    if (law->mode == ServoMode::Effort) continue;
    const double measured = actuator.drive.gear && !servo.on_link ? rates.rotors[i] : rates.coordinates[c];
    const double wanted = law->mode == ServoMode::Velocity ? set_point : set_rate;
    Coordinate& coordinate = frozen.coordinates[c];
    const double of_scene = coordinate.effort < 0 ? 0 : frozen.histories[coordinate.effort](state.time);
    state.commands[c] = applied_effort(coordinate, state.commands[c], of_scene) + law->derivative * (wanted - measured);
    double& limit = frozen.actuators[i].servo->effort_limit;
    if (coordinate.effort_limit > 0) limit = std::min(limit, coordinate.effort_limit);
    coordinate.effort_limit = 0;
  }
}

std::vector<int> separate_rotors(const Model& model, const DegreesOfFreedom& dof) {
  std::vector<int> rotors;
  for (std::size_t i = 0; i < model.actuators.size(); ++i)
    if (model.actuators[i].drive.gear && equation_of(model, dof, i) >= 0) rotors.push_back(static_cast<int>(i));
  return rotors;
}

std::vector<double> efforts_of_gear_dampers(const Model& model, const State& state, const ActuatorRates& rates) {
  assert(rates.coordinates.size() == model.coordinates.size() && rates.rotors.size() == model.actuators.size());
  std::vector<double> efforts(model.actuators.size(), 0.0);
  for (std::size_t i = 0; i < efforts.size(); ++i) {
    const Actuator& actuator = model.actuators[i];
    if (!actuator.drive.gear) continue;
    efforts[i] = elastic_damping(*actuator.drive.gear, gear_twist(model, state, i)) *
                 (rates.rotors[i] - rates.coordinates[actuator.coordinate]);
  }
  return efforts;
}

RotorEntries rotor_entries(const Model& model, const DegreesOfFreedom& dof, const State& state,
                           const Actuators& resting, int first) {
  RotorEntries entries;
  entries.actuators = separate_rotors(model, dof);
  int rotor = first;
  for (const int i : entries.actuators) {
    const Actuator& actuator = model.actuators[i];
    const int q = equation_of(model, dof, i);
    CoordinateStep twist;
    twist.begin = twist.end = gear_twist(model, state, i);
    const Elasticity& gear = *actuator.drive.gear;
    const ServoLaw* law = resting.is_cut(i) ? nullptr : law_in_force(actuator, state.actuators[i]);
    const bool holds = law && law->mode == ServoMode::Position;
    add(coupling(-elastic_effort(gear, twist).slope, actuator.servo, holds ? law->proportional : 0), q, rotor,
        entries.stiffness);
    entries.stiffness.emplace_back(q, q, -resting.stiffness(i));
    add(coupling(elastic_damping(gear, twist.end), actuator.servo, law ? law->derivative : 0), q, rotor,
        entries.damping);
    entries.mass.emplace_back(rotor, rotor, actuator.drive.inertia);
    ++rotor;
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
  // The stiffness has entries at all four places of a coordinate and its rotor.
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
