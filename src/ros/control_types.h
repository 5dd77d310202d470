#pragma once
/// Messages of controllers: control_msgs' own where that package was found, else ours, which have the same fields and
/// checksums.

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
