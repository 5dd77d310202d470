#pragma once
/// Arms with random dimensions, joints and loads.

#include <string>

namespace flexarm::bench {

constexpr int kRandomArms = 20;

/// The scene file of arm `index`: one to seven revolute joints about random axes, rigid and flexible links of random
/// sizes, at random angles, that falls under its weight. Of the odd ones the beams have elements="auto". The same text
/// everywhere.
std::string random_arm(int index);
/// How many joints it has.
int random_arm_joints(int index);

}  // namespace flexarm::bench
