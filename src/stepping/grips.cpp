#include "grips.h"

#include <algorithm>
#include <cmath>

#include "flexarm/scene/scene_description.h"

namespace flexarm::node {
namespace {

struct PositionGains {
  double kp = 0, kd = 0, ki = 0;
};

/// The present gains of a coordinate's servo in mode position; zeros if there is none.
PositionGains position_gains(const Simulation& simulation, std::size_t joint) {
  const std::string& name = simulation.coordinate_names()[joint];
  for (const scene::ServoDescription& servo : simulation.scene().servos) {
    if (servo.coordinate != name) continue;
    if (servo.mode == ServoMode::Position) return {servo.kp, servo.kd, servo.ki};
    for (const scene::ServoDescription::Gains& gains : servo.other_modes)
      if (gains.mode == ServoMode::Position) return {gains.kp, gains.kd, gains.ki};
  }
  return {};
}

/// The set point nearest to `wanted` for which the servo's effort at the present position is at most `max_effort`.
double limited_set_point(const Simulation& simulation, std::size_t joint, double wanted, double max_effort) {
  const PositionGains gains = position_gains(simulation, joint);
  if (max_effort <= 0 || gains.kp <= 0) return wanted;
  const double position = simulation.position(joint);
  // The integral part of the effort is the rest of the last step's effort. Subtracting it also prevents windup.
  double integral = 0;
  if (gains.ki > 0)
    integral = simulation.effort(joint) - gains.kp * (simulation.set_point(joint) - position) +
               gains.kd * simulation.velocity(joint);
  return std::clamp(wanted, position + (-max_effort - integral) / gains.kp,
                    position + (max_effort - integral) / gains.kp);
}

}  // namespace

void Grips::close(std::size_t joint, double position, double max_effort) {
  release(joint);
  grips_.push_back({joint, position, max_effort});
}

void Grips::renumber(const Renumbering::Places& joints) {
  const auto is_gone = [&](const Grip& grip) { return !joints[grip.joint]; };
  grips_.erase(std::remove_if(grips_.begin(), grips_.end(), is_gone), grips_.end());
  for (Grip& grip : grips_) grip.joint = *joints[grip.joint];
}

void Grips::release(std::size_t joint) {
  grips_.erase(std::remove_if(grips_.begin(), grips_.end(), [joint](const Grip& grip) { return grip.joint == joint; }),
               grips_.end());
}

bool Grips::holds(std::size_t joint) const {
  return std::any_of(grips_.begin(), grips_.end(), [joint](const Grip& grip) { return grip.joint == joint; });
}

void Grips::command(Simulation& simulation) {
  for (const Grip& grip : grips_)
    simulation.command_set_point(grip.joint, limited_set_point(simulation, grip.joint, grip.position, grip.max_effort));
}

std::string Grips::refusal_of_limit(const Simulation& simulation, std::size_t joint) {
  if (position_gains(simulation, joint).kp > 0) return {};
  return "the servo of '" + simulation.coordinate_names()[joint] + "' has no kp, so that its effort cannot be limited";
}

}  // namespace flexarm::node
