#include "integrators/explicit_rotors.h"

#include "joints/elasticity.h"
#include "joints/joint_forces.h"
#include "joints/motor_step.h"

namespace flexarm {
namespace {

Vector6 moment_on_carrier(const Vector3& moment) {
  Vector6 wrench;
  wrench << Vector3::Zero(), moment;
  return wrench;
}

}  // namespace

ExplicitRotors::ExplicitRotors(const Model& model) : model_(model), places_(model.actuators.size(), -1) {
  actuators_.reserve(places_.size());
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (!model.actuators[i].drive.gear) continue;
    places_[i] = static_cast<int>(size());
    actuators_.push_back(static_cast<int>(i));
  }
  moments_.resize(actuators_.size(), Vector3::Zero());
}

void ExplicitRotors::pack(const State& state, double* unknowns) const {
  for (const int actuator : actuators_) {
    *unknowns++ = state.actuators[actuator].angle;
    *unknowns++ = state.actuators[actuator].rate;
  }
}

bool ExplicitRotors::are_those_of(const State& state, const double* unknowns) const {
  for (const int actuator : actuators_) {
    const double* own = unknowns + places_[actuator];
    if (own[0] != state.actuators[actuator].angle || own[1] != state.actuators[actuator].rate) return false;
  }
  return true;
}

ExplicitRotors::Motion ExplicitRotors::motion(std::size_t actuator, const double* unknowns, const Motion& link,
                                              const ArticulatedBodies& bodies) const {
  const int place = places_[actuator];
  if (place < 0) return link;
  Motion out{unknowns[place], unknowns[place + 1]};
  if (const std::optional<Gyroscope>& gyroscope = model_.actuators[actuator].gyroscope) {
    const Vector3 axis = bodies.rotation(gyroscope->node) * gyroscope->axis;
    out.rate -= axis.dot(bodies.velocity(gyroscope->node).tail<3>()) / gyroscope->ratio;
  }
  return out;
}

double ExplicitRotors::act(std::size_t actuator, double motor, const Motion& rotor, const Motion& link,
                           const double* unknowns, double* changes, double& dissipated, ArticulatedBodies& bodies) {
  const Drive& drive = model_.actuators[actuator].drive;
  const int place = places_[actuator];
  const ElasticInstant gear = elastic_instant(*drive.gear, rotor.angle - link.angle, rotor.rate - link.rate);
  const double friction = friction_capacity(drive, gear.effort) * smooth_friction(rotor.rate);
  const double effort = motor + gear.effort - friction;
  dissipated += gear.dissipated + friction * rotor.rate;
  changes[place] = rotor.rate;
  changes[place + 1] = effort / drive.inertia;
  if (const std::optional<Gyroscope>& gyroscope = model_.actuators[actuator].gyroscope) {
    // The momentum p about the axis a changes by the effort / ratio; the carrier gets -d(p a)/dt.
    const Vector3 axis = bodies.rotation(gyroscope->node) * gyroscope->axis,
                  spin = bodies.velocity(gyroscope->node).tail<3>();
    const double momentum = gyroscope->inertia * gyroscope->ratio * unknowns[place + 1];
    Vector3& moment = moments_[place / 2];
    moment = -(effort / gyroscope->ratio * axis + momentum * spin.cross(axis));
    bodies.add_force(gyroscope->node, moment_on_carrier(moment));
  }
  return -gear.effort;
}

void ExplicitRotors::add_moments(ArticulatedBodies& bodies) const {
  for (std::size_t i = 0; i < actuators_.size(); ++i)
    if (const std::optional<Gyroscope>& gyroscope = model_.actuators[actuators_[i]].gyroscope)
      bodies.add_force(gyroscope->node, moment_on_carrier(moments_[i]));
}

void ExplicitRotors::strike(std::size_t actuator, double impulse, double* unknowns, ArticulatedBodies& bodies) const {
  unknowns[places_[actuator] + 1] += impulse / model_.actuators[actuator].drive.inertia;
  if (const std::optional<Gyroscope>& gyroscope = model_.actuators[actuator].gyroscope)
    bodies.add_force(gyroscope->node, moment_on_carrier(-impulse / gyroscope->ratio *
                                                        (bodies.rotation(gyroscope->node) * gyroscope->axis)));
}

}  // namespace flexarm
