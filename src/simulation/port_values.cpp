#include "simulation/linear_ports.h"

#include <stdexcept>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "math/so3.h"
#include "simulation/inside.h"
#include "simulation/linear_names.h"
#include "simulation/observables.h"
#include "simulation/published_motion.h"

namespace flexarm {
namespace {

using Kind = LinearPort::Kind;

Vector6 vector6(const Vector3& upper, const Vector3& lower) {
  Vector6 out;
  out << upper, lower;
  return out;
}

double coordinate_value(const Simulation& simulation, const LinearPort& port) {
  const std::size_t coordinate = static_cast<std::size_t>(port.coordinate);
  if (port.kind == Kind::Position) return simulation.position(coordinate);
  if (port.kind == Kind::Velocity) return simulation.velocity(coordinate);
  return simulation.effort(coordinate);
}

class PointValues {
 public:
  PointValues(const Simulation& simulation, const Simulation& reference)
      : model_(model_of(simulation)),
        state_(state_of(simulation)),
        velocities_(published_rates(simulation).nodes),
        reference_(reference) {
    past_.update({model_, dof_, scheme_ = scheme_of(simulation), state_});
  }

  double value(const LinearPort& port) const {
    const ProbeState probe = probe_state(model_, state_, velocities_, port.point);
    if (port.kind == Kind::Velocity) return vector6(probe.velocity, probe.angular_velocity)[port.component];
    if (port.kind == Kind::Acceleration) {
      const ProbeAcceleration change = past_.acceleration({model_, dof_, scheme_, state_}, port.point);
      return vector6(change.linear, change.angular)[port.component];
    }
    const std::vector<Vector6> still(velocities_.size(), Vector6::Zero());
    const ProbeState start = probe_state(model_of(reference_), state_of(reference_), still, port.point);
    const Quaternion turned = probe.pose.orientation * start.pose.orientation.conjugate();
    return vector6(probe.pose.position + probe_origin(model_, state_, port.point),
                   so3::log(so3::nearer_of_two(turned, Quaternion::Identity())))[port.component];
  }

 private:
  const Model& model_;
  const State& state_;
  std::vector<Vector6> velocities_;
  const Simulation& reference_;
  DegreesOfFreedom dof_{model_};
  Scheme scheme_;
  PastMotion past_;
};

}  // namespace

Eigen::VectorXd port_values(const Simulation& simulation, const Simulation& reference,
                            const std::vector<LinearPort>& ports) {
  const PointValues points(simulation, reference);
  Eigen::VectorXd values(static_cast<Eigen::Index>(ports.size()));
  for (std::size_t i = 0; i < ports.size(); ++i) {
    const LinearPort& port = ports[i];
    const bool is_joint = port.coordinate >= 0;
    if ((is_joint && port.kind == Kind::Acceleration) || port.kind == Kind::Strain || port.kind == Kind::SectionForce)
      throw std::invalid_argument(fmt::format(
          "output '{}' has no sensitivities: expected position:, velocity:, acceleration: of a point, or effort:",
          port.name));
    values[static_cast<Eigen::Index>(i)] = is_joint ? coordinate_value(simulation, port) : points.value(port);
  }
  return values;
}

}  // namespace flexarm
