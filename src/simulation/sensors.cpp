#include "simulation/sensors.h"

#include <cmath>

#include "math/normal_noise.h"
#include "math/so3.h"
#include "model/carried_origin.h"
#include "simulation/observables.h"
#include "simulation/touching.h"

namespace flexarm {
namespace {

using scene::Sensor;
using scene::SensorKind;

constexpr std::size_t kMostErrors = 6;
using Errors = Eigen::Matrix<double, kMostErrors, 1>;
/// Relative to a sample's interval: a sample may be early by this much and still be on time.
constexpr double kRoundOff = 1e-6;

/// Number of the last sample at `time`, counted from t = 0. A sensor without a rate takes a sample after each step.
long sample_at(const Sensor& sensor, double time, long steps) {
  return sensor.rate > 0 ? static_cast<long>(std::floor(time * sensor.rate + kRoundOff)) : steps;
}

/// FNV-1a hash.
std::uint64_t hashed(const std::string& name) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

double channel_value(const std::vector<double>& values, std::size_t channel) {
  if (values.empty()) return 0;
  return values.size() == 1 ? values[0] : values[channel];
}

/// Bias and noise of a sample.
Errors errors_of(const Sensor& sensor, long sample) {
  Errors errors = Errors::Zero();
  const std::size_t count = scene::traits_of(sensor.kind).errors;
  for (std::size_t i = 0; i < count; ++i) errors[i] = channel_value(sensor.bias, i);
  if (sensor.noise.empty()) return errors;
  const std::uint64_t stream = NormalNoise::mixed(hashed(sensor.name) + static_cast<std::uint64_t>(sensor.seed));
  NormalNoise noise(stream + static_cast<std::uint64_t>(sample));
  for (std::size_t i = 0; i < count; ++i) errors[i] += channel_value(sensor.noise, i) * noise.next();
  return errors;
}

Pose link_pose(const SensorPlace& place, const MotionView& view) {
  return attached_pose(view.state, view.model.links[place.point.link].frame);
}

Vector6 measured_wrench(const Sensor& sensor, const SensorPlace& place, const MotionView& view) {
  const Wrench wrench = sensed_wrench(view.model, view.state, place);
  const bool in_world = scene::traits_of(sensor.kind).in_world;
  const Quaternion axes =
      in_world ? Quaternion(Quaternion::Identity()) : link_pose(place, view).orientation.conjugate();
  Vector6 out;
  out << axes * wrench.force, axes * wrench.moment;
  return out;
}

/// The sum of the wrenches of all contacts.
Vector6 touching_wrench(const SensorPlace& place, const MotionView& view, PublishedMotion& motion) {
  // Touching points are relative to the state's origin, also if the sensor is on the world, which is not.
  const Vector3 about = probe_pose(view.model, view.state, place.point).position +
                        probe_origin(view.model, view.state, place.point) - world_origin(view.model, view.state);
  Wrench sum;
  for (const auto& [pair, is_first] : place.touched) {
    const double sign = is_first ? 1 : -1;
    touch(view.model.touching_pairs[pair], view, motion, [&](const TouchingPoint& point) {
      const Vector3 force = sign * (point.push + point.friction);
      sum.force += force;
      sum.moment += (point.position - about).cross(force) + sign * point.couple;
    });
  }
  const Quaternion axes = link_pose(place, view).orientation.conjugate();
  Vector6 out;
  out << axes * sum.force, axes * sum.moment;
  return out;
}

Vector6 measured_motion(const SensorPlace& place, const MotionView& view, PublishedMotion& motion) {
  const ProbeState probe = probe_state(view.model, view.state, motion.velocities(view).nodes(), place.point);
  const ProbeAcceleration acceleration = motion.past(view).acceleration(view, place.point);
  const Quaternion axes = probe.pose.orientation.conjugate();
  Vector6 out;
  out << axes * probe.angular_velocity, axes * Vector3(acceleration.linear - view.model.gravity);
  return out;
}

Vector6 measured_twist(const SensorPlace& place, const MotionView& view, PublishedMotion& motion) {
  const ProbeState probe = probe_state(view.model, view.state, motion.velocities(view).nodes(), place.point);
  Vector6 out;
  out << probe.velocity, probe.angular_velocity;
  return out;
}

/// Sets a sample to a pose in the world, with errors in the axes of the pose.
void set_pose(const Pose& pose, const Errors& errors, SensorSample& sample) {
  const Vector3 position = pose.position + pose.orientation * errors.head<3>();
  const Quaternion orientation = (pose.orientation * so3::exp_quaternion(Vector3(errors.tail<3>()))).normalized();
  for (int i = 0; i < 3; ++i) sample.values[i] = position[i];
  for (int i = 0; i < 4; ++i) sample.values[3 + i] = orientation.coeffs()[i];  // x y z w
}

void measure(const Sensor& sensor, const SensorPlace& place, const MotionView& view, PublishedMotion& motion,
             const Errors& errors, SensorSample& sample) {
  const auto set = [&](const Vector6& values) {
    for (int i = 0; i < 6; ++i) sample.values[i] = values[i] + errors[i];
  };
  switch (sensor.kind) {
    case SensorKind::Wrench:
    case SensorKind::Reaction:
      return set(measured_wrench(sensor, place, view));
    case SensorKind::SectionForce: {
      const auto& [link, attachment, element, xi, offset] = place.point;
      return set(section_point(view.model, view.state, *view.model.links[link].beam, element, xi).resultant);
    }
    case SensorKind::Strain:
      sample.values[0] = fibre_strain(view.model, view.state, place.point) + errors[0];
      return;
    case SensorKind::Contact:
      return set(touching_wrench(place, view, motion));
    case SensorKind::Imu:
      return set(measured_motion(place, view, motion));
    case SensorKind::Twist:
      return set(measured_twist(place, view, motion));
    case SensorKind::Tendon: {
      thread_local std::vector<double> outputs;  // the length, the tension at the first guide, ...
      outputs.clear();
      put_out(place.force_element, view, motion, outputs);
      for (int i = 0; i < 2; ++i) sample.values[i] = outputs[i] + errors[i];
      return;
    }
    case SensorKind::Pose:
      return set_pose(pose_in_world(view.model, view.state, place.point), errors, sample);
  }
}

}  // namespace

Wrench transmitted_wrench(const Model& model, const State& state, int reaction, const Vector3& about) {
  Wrench wrench;
  for (int k = 0; k < 3; ++k) {
    wrench.force[k] = state.transmitted.at_end(6 * static_cast<std::size_t>(reaction) + k);
    wrench.moment[k] = state.transmitted.at_end(6 * static_cast<std::size_t>(reaction) + 3 + k);
  }
  const Vector3 way = about - attached_pose(state, model.reactions[reaction].point).position;
  wrench.moment -= way.cross(wrench.force);
  return wrench;
}

Wrench sensed_wrench(const Model& model, const State& state, const SensorPlace& place) {
  return transmitted_wrench(model, state, place.reaction, probe_pose(model, state, place.point).position);
}

void take_samples(const std::vector<Sensor>& sensors, const MotionView& view, PublishedMotion& motion, bool all,
                  std::vector<SensorSample>& samples) {
  const double time = view.state.time;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const Sensor& sensor = sensors[i];
    const long number = sample_at(sensor, time, view.state.steps);
    const bool is_due = sensor.rate > 0 ? number > sample_at(sensor, samples[i].time, 0) : samples[i].time != time;
    if (!all && samples[i].time >= 0 && !is_due) continue;
    samples[i].time = time;
    measure(sensor, view.model.sensors[i], view, motion, errors_of(sensor, number), samples[i]);
  }
}

}  // namespace flexarm
