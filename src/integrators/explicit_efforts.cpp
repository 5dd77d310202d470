// What acts on the bodies at an instant of a step of an explicit scheme.
#include "integrators/explicit_loads.h"
#include "integrators/explicit_step.h"
#include "integrators/step_histories.h"
#include "joints/elasticity.h"
#include "joints/joint_forces.h"

namespace flexarm {

/// The motion of a coordinate. That of an angle of a free rotation has no position.
ExplicitRotors::Motion ExplicitStep::link_motion(std::size_t coordinate, const std::vector<double>& numbers) const {
  const Coordinate& data = model_.coordinates[coordinate];
  const double position = data.is_angle ? 0 : released_[data.joint].displacement[data.component];
  return {position, numbers[rates_ + places_[coordinate]]};
}

/// Sets the efforts on all rates. Adds their work and what they dissipate to `change`, and sets the derivatives of the
/// integrals of servos and of the rotors' unknowns there.
void ExplicitStep::find_efforts(const State& state, const std::vector<double>& numbers, std::vector<double>& change) {
  for (std::size_t i = 0; i < model_.coordinates.size(); ++i) {
    if (places_[i] < 0) continue;
    const Coordinate& coordinate = model_.coordinates[i];
    const ExplicitRotors::Motion link = link_motion(i, numbers);
    const double of_scene = coordinate.effort < 0 ? 0 : values_[coordinate.effort];
    double& applied = applied_[i] = applied_effort(coordinate, state.commands[i], of_scene);
    margins_.set_reversal(rubbing_joints_[i], link.rate);
    margins_.set(limits_[i], of_scene, -coordinate.effort_limit, coordinate.effort_limit);
    if (coordinate.motion >= 0) {
      efforts_[places_[i]] = applied = 0;  // until the motion is known to need one
    } else if (coordinate.actuator >= 0) {
      drive(coordinate.actuator, state, link, numbers, change, applied);
    } else {
      efforts_[places_[i]] = applied;
      change[work_] += applied * link.rate;
    }
    if (coordinate.actuator >= 0 || resists(coordinate)) add_passive(i, link, change);
  }
}

/// Changes the effort on a motor's coordinate to what the motor gives, and sets what its gear transmits.
void ExplicitStep::drive(std::size_t actuator, const State& state, const ExplicitRotors::Motion& link,
                         const std::vector<double>& numbers, std::vector<double>& change, double& applied) {
  const std::size_t integral = integrals_ + actuator;
  const double* own = numbers.data() + own_;
  const ExplicitRotors::Motion rotor = rotors_.motion(actuator, own, link, bodies_);
  applied = motors_.effort(actuator, state, applied, rotor, link, numbers[integral], change[integral]);
  change[work_] += applied * rotor.rate;
  double& effort = efforts_[places_[model_.actuators[actuator].coordinate]] = applied;
  if (rotors_.place(actuator) < 0) return;
  const double play = 0.5 * model_.actuators[actuator].drive.gear->backlash;
  margins_.set_reversal(rubbing_rotors_[actuator], rotor.rate);
  margins_.set(plays_[actuator], rotor.angle - link.angle, -play, play);
  effort = rotors_.act(actuator, applied, rotor, link, own, change.data() + own_, change[work_ + 1], bodies_);
}

void ExplicitStep::add_passive(std::size_t coordinate, const ExplicitRotors::Motion& link,
                               std::vector<double>& change) {
  const Coordinate& data = model_.coordinates[coordinate];
  double& effort = efforts_[places_[coordinate]];
  if (resists(data)) {
    CoordinateStep now{link.angle, link.angle, link.rate, 1};
    now.at_end = true;
    now.below = events_.contacts(coordinate)[0];
    now.above = events_.contacts(coordinate)[1];
    const double passive = passive_effort(data, now).effort;
    now.increment = 0;
    now.below = now.above = StopContact::ByDepth;
    const double elastic = passive_effort(data, now).effort;
    effort += passive;
    change[work_ + 1] -= (passive - elastic) * link.rate;
  }
  if (data.actuator < 0 || !model_.actuators[data.actuator].spring) return;
  const JointSpring& spring = *model_.actuators[data.actuator].spring;
  const ElasticInstant coil = elastic_instant(spring.elasticity, link.angle - spring.rest, link.rate);
  effort += coil.effort;
  change[work_ + 1] += coil.dissipated;
}

Eigen::MatrixXd ExplicitStep::mobility(const State& state, double step) {
  last_nodes_.clear();
  pack(state);
  begin_[work_] = begin_[work_ + 1] = 0;
  find_values(state.time, step, 0);
  if (dependent_.any() && !begin_dependent(state, step, begin_[work_])) return {};
  const auto changes_by = [&](const std::vector<double>& efforts) {
    std::vector<double> change(begin_.size());
    if (place(0, begin_)) accelerate(0, efforts.data(), change);
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(change.data() + rates_, bodies_.rate_count()));
  };
  const Eigen::VectorXd without = changes_by(no_efforts_);
  Eigen::MatrixXd out(bodies_.rate_count(), bodies_.rate_count());
  for (int i = 0; i < bodies_.rate_count(); ++i) {
    std::vector<double> unit = no_efforts_;
    unit[static_cast<std::size_t>(i)] = 1;
    out.col(i) = changes_by(unit) - without;
  }
  return out;
}

void ExplicitStep::add_loads(const State& state, std::vector<double>& change) {
  for_each_load(model_, state, values_, bodies_, [&](const NodalLoad& load, const Vector6& wrench) {
    bodies_.add_force(load.node, wrench);
    change[work_] += wrench.dot(bodies_.velocity(load.node));
  });
}

}  // namespace flexarm
