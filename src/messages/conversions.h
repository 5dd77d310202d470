#pragma once
/// Converts the core's types to messages, and back.

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Vector3.h>

#include "flexarm/math/pose.h"

namespace flexarm::messages {

/// Converts a message with x, y and z.
template <class Message>
Vector3 to_vector(const Message& message) {
  return {message.x, message.y, message.z};
}

inline geometry_msgs::Vector3 to_vector3(const Vector3& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

inline geometry_msgs::Point to_point(const Vector3& point) {
  geometry_msgs::Point message;
  message.x = point.x();
  message.y = point.y();
  message.z = point.z();
  return message;
}

inline geometry_msgs::Quaternion to_quaternion(const Quaternion& quaternion) {
  geometry_msgs::Quaternion message;
  message.x = quaternion.x();
  message.y = quaternion.y();
  message.z = quaternion.z();
  message.w = quaternion.w();
  return message;
}

inline geometry_msgs::Pose to_pose(const Pose& pose) {
  geometry_msgs::Pose message;
  message.position = to_point(pose.position);
  message.orientation = to_quaternion(pose.orientation);
  return message;
}

inline geometry_msgs::Transform to_transform(const Pose& pose) {
  geometry_msgs::Transform message;
  message.translation = to_vector3(pose.position);
  message.rotation = to_quaternion(pose.orientation);
  return message;
}

}  // namespace flexarm::messages
