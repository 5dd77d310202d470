#include "messages/sensor_messages.h"

#include "flexarm/scene/scene_description.h"
#include "messages/conversions.h"

namespace flexarm::messages {
namespace {

using scene::SensorKind;

/// Three values of a sample.
Vector3 part(const SensorSample& sample, std::size_t first) {
  return {sample.values[first], sample.values[first + 1], sample.values[first + 2]};
}

geometry_msgs::WrenchStamped wrench_message(const SensorSample& sample) {
  geometry_msgs::WrenchStamped message;
  message.wrench.force = to_vector3(part(sample, 0));
  message.wrench.torque = to_vector3(part(sample, 3));
  return message;
}

/// In a covariance, -1 in the first entry means that the quantity is not measured; all zeros mean an unknown
/// covariance.
sensor_msgs::Imu imu_message(const SensorSample& sample) {
  sensor_msgs::Imu message;
  message.angular_velocity = to_vector3(part(sample, 0));
  message.linear_acceleration = to_vector3(part(sample, 3));
  message.orientation.w = 1;
  message.orientation_covariance[0] = -1;
  return message;
}

geometry_msgs::PoseStamped pose_message(const SensorSample& sample) {
  geometry_msgs::PoseStamped message;
  message.pose.position = to_point(part(sample, 0));
  message.pose.orientation =
      to_quaternion(Quaternion(sample.values[6], sample.values[3], sample.values[4], sample.values[5]));
  return message;
}

geometry_msgs::TwistStamped twist_message(const SensorSample& sample) {
  geometry_msgs::TwistStamped message;
  message.twist.linear = to_vector3(part(sample, 0));
  message.twist.angular = to_vector3(part(sample, 3));
  return message;
}

StrainStamped strain_message(const SensorSample& sample) {
  StrainStamped message;
  message.strain = sample.values[0];
  return message;
}

TendonStamped tendon_message(const SensorSample& sample) {
  TendonStamped message;
  message.length = sample.values[0];
  message.tension = sample.values[1];
  return message;
}

SensorMessage message_of(SensorKind kind, const SensorSample& sample) {
  switch (kind) {
    case SensorKind::Imu:
      return imu_message(sample);
    case SensorKind::Pose:
      return pose_message(sample);
    case SensorKind::Twist:
      return twist_message(sample);
    case SensorKind::Strain:
      return strain_message(sample);
    case SensorKind::Tendon:
      return tendon_message(sample);
    default:
      return wrench_message(sample);
  }
}

}  // namespace

SensorMessage sensor_message(const Simulation& simulation, std::size_t index, const ros::Time& stamp,
                             const std::string& prefix) {
  const scene::SceneDescription& scene = simulation.scene();
  const scene::Sensor& sensor = scene.sensors[index];
  const bool in_world = scene::traits_of(sensor.kind).in_world;
  SensorMessage message = message_of(sensor.kind, simulation.sample(index));
  std::visit(
      [&](auto& content) {
        content.header.stamp = stamp;
        content.header.frame_id = prefix + (in_world ? scene.root_link : sensor.link);
      },
      message);
  return message;
}

}  // namespace flexarm::messages
