#pragma once
/// Message types of controllers: those of control_msgs if CMake found that package, else flexarm's own, which have the
/// same fields and checksums.

#ifdef FLEXARM_HAS_CONTROL_MSGS
#include <control_msgs/FollowJointTrajectoryAction.h>
#include <control_msgs/GripperCommandAction.h>
#include <control_msgs/JointTolerance.h>
namespace flexarm::node {
namespace control = ::control_msgs;
}
#else
#include <flexarm/FollowJointTrajectoryAction.h>
#include <flexarm/GripperCommandAction.h>
#include <flexarm/JointTolerance.h>
namespace flexarm::node {
namespace control = ::flexarm;
}
#endif
