#pragma once
/// Makes arms with random dimensions, joints and loads.

#include <string>

namespace flexarm::bench {

constexpr int kRandomArms = 20;

/// The scene file of arm `index`. It has one to seven revolute joints about random axes, rigid and flexible links of
/// random sizes at random angles, and falls under its weight. In arms with an odd index, beams have elements="auto".
/// The text is the same on all systems.
std::string random_arm(int index);
/// Number of joints of the arm.
int random_arm_joints(int index);

}  // namespace flexarm::bench
