#pragma once
/// Random steps of joints of each kind, for tests of their maps and rates.

#include <gtest/gtest.h>

#include "elements/random_element.h"
#include "joints/joint_map.h"

namespace flexarm::test {

/// A joint over a step.
struct JointStep {
  JointMap joint;
  NodePose master_begin, master_end;
  Released begin, end;

  int released() const { return released_count(joint.kind); }
  /// Number of scalars that determine the slave's pose: the released ones, then {dr, spin} of the master if it is a
  /// node.
  int columns() const { return released() + (joint.master < 0 ? 0 : 6); }
  NodePose slave_begin() const { return slave_pose(joint, master_begin, begin); }
  NodePose slave_end() const { return slave_pose(joint, master_end, end); }
  /// The same joint without an arm.
  JointStep without_arm() const {
    JointStep out = *this;
    out.joint.arm.setZero();
    return out;
  }

  /// The step whose end is displaced by h along one of columns().
  JointStep perturbed(int column, double h) const;
};

struct KindOfJoint {
  const char* name;
  JointMapKind kind;
  bool translates, rotates;  // of kind Scalar
  bool by_profile = false;   // whether a cam profile gives the travel
};

inline const KindOfJoint kKinds[] = {
    {"Rigid", JointMapKind::Rigid, false, false},     {"Revolute", JointMapKind::Scalar, false, true},
    {"Prismatic", JointMapKind::Scalar, true, false}, {"Coupled", JointMapKind::Scalar, true, true},
    {"Cam", JointMapKind::Scalar, true, true, true},  {"Spherical", JointMapKind::Spherical, false, false},
    {"Free", JointMapKind::Free, false, false}};

/// A random step with increments of size `size` in all quantities. The axes are neither unit vectors nor parallel to
/// each other.
JointStep random_step(RandomSource& random, const KindOfJoint& kind, bool world, double size);

enum class Form { Variational, Incremental };

FoldMaps maps_of(const JointStep& step, const Vector6& g, Form form, bool with_tangent = true, double arm_weight = 0.5);

/// A kind of joint, and whether its master is the world.
using Parameter = std::tuple<KindOfJoint, bool>;
class OfEveryJoint : public ::testing::TestWithParam<Parameter> {
 protected:
  JointStep random(double size) { return random_step(source, std::get<0>(GetParam()), std::get<1>(GetParam()), size); }
  RandomSource source{7};
};

std::string parameter_name(const ::testing::TestParamInfo<Parameter>& info);

}  // namespace flexarm::test
