#pragma once
/// Compares states bit for bit.

#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "model/state.h"

namespace flexarm::test {

/// All numbers of a state.
inline std::vector<double> numbers(const State& state) {
  std::vector<double> out{state.time,
                          state.work,
                          state.dissipated,
                          double(state.steps),
                          double(state.history.count),
                          double(state.history.order)};
  const auto add = [&](const auto& v) { out.insert(out.end(), v.data(), v.data() + v.size()); };
  for (const auto& made : state.history.increments) add(made);
  add(state.history.steps);
  for (const NodeState& node : state.nodes) {
    add(node.position);
    add(node.orientation.coeffs());
    add(node.velocity);
    add(node.angular_velocity);
    add(node.acceleration);
    add(node.angular_acceleration);
  }
  for (const Released& released : state.released) add(released.displacement), add(released.rotation.coeffs());
  for (const MassPointState& point : state.study.mass_points)
    add(point.angular_velocity), add(point.angular_acceleration);
  for (const Vector6& rate : state.study.strain_rates) add(rate);
  for (const Vector6& strain : state.branch_strains) add(strain);
  out.insert(out.end(), state.efforts.begin(), state.efforts.end());
  out.insert(out.end(), state.force_memory.begin(), state.force_memory.end());
  for (const ActuatorState& actuator : state.actuators) {
    out.insert(out.end(), {actuator.angle, actuator.rate, actuator.acceleration, actuator.rest});
    const ServoState& servo = actuator.servo;
    out.insert(out.end(),
               {servo.set_point, servo.integral, servo.average, servo.delayed_rate, servo.samples, servo.measured});
    out.insert(out.end(), servo.outputs.begin(), servo.outputs.end());
  }
  return out;
}

inline ::testing::AssertionResult same_bits(const State& a, const State& b) {
  const std::vector<double> x = numbers(a), y = numbers(b);
  if (x.size() != y.size()) return ::testing::AssertionFailure() << "different sizes";
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::memcmp(&x[i], &y[i], sizeof(double)) != 0)
      return ::testing::AssertionFailure()
             << "number " << i << " of " << x.size() << ": " << x[i] << " and " << y[i] << " differ by " << x[i] - y[i];
  return ::testing::AssertionSuccess();
}

}  // namespace flexarm::test
