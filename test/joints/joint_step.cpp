// Random steps of joints for tests; see joint_step.h.
#include "joints/joint_step.h"

#include "math/so3.h"
#include "support/node_poses.h"

namespace flexarm::test {

JointStep JointStep::perturbed(int column, double h) const {
  JointStep out = *this;
  const int count = released();
  if (column < count) {
    out.end = updated(joint, end, h * ReleasedVector::Unit(count, column));
  } else if (column < count + 3) {
    out.master_end.position[column - count] += h;
  } else {
    const Vector3 spin = h * Vector3::Unit(column - count - 3);
    out.master_end.orientation = (so3::exp_quaternion(spin) * master_end.orientation).normalized();
    out.master_end.rotation = out.master_end.orientation.toRotationMatrix();
  }
  return out;
}

JointStep random_step(RandomSource& random, const KindOfJoint& kind, bool world, double size) {
  JointStep out;
  out.joint.kind = kind.kind;
  out.joint.master = world ? -1 : 0;
  out.joint.slave = 1;
  out.joint.origin = random.pose(1, 3);
  out.joint.slave_orientation = random.rotation(3);
  out.joint.arm = random.vector();
  if (kind.translates) out.joint.translation = 0.7 * random.unit();
  if (kind.rotates) out.joint.rotation = 1.2 * random.unit();
  if (kind.kind == JointMapKind::Scalar) place(out.joint, Pose());
  if (kind.by_profile)  // analytic, since differences must not cross knots
    out.joint.profile = std::make_shared<CamProfile>(CamProfile::eccentric(0.6, 0.1));
  if (!world) {
    out.master_begin = node_at(random.vector(), random.rotation(3));
    out.master_end = node_at(out.master_begin.position + size * random.vector(),
                             so3::exp_quaternion(Vector3(size * random.unit())) * out.master_begin.orientation);
  }
  const double sign = random.number() < 0 ? -1 : 1;
  if (kind.kind == JointMapKind::Scalar) {
    out.begin.displacement[0] = 2 * random.number();
    out.end.displacement[0] = out.begin.displacement[0] + sign * size;
  } else if (kind.kind != JointMapKind::Rigid) {
    out.begin.rotation = random.rotation(3);
    out.end.rotation = (so3::exp_quaternion(Vector3(size * random.unit())) * out.begin.rotation).normalized();
    if (kind.kind == JointMapKind::Free) {
      out.begin.displacement = random.vector();
      out.end.displacement = out.begin.displacement + size * random.vector();
    }
  }
  return out;
}

FoldMaps maps_of(const JointStep& step, const Vector6& g, Form form, bool with_tangent, double arm_weight) {
  FoldMaps maps;
  const NodePose slave_begin = step.slave_begin(), slave_end = step.slave_end();
  const JointPose begin{step.master_begin, slave_begin, step.begin}, end{step.master_end, slave_end, step.end};
  if (form == Form::Variational)
    variational_maps(step.joint, end, g, maps);
  else
    incremental_maps(step.joint, begin, end, g, maps, with_tangent, arm_weight);
  return maps;
}

std::string parameter_name(const ::testing::TestParamInfo<Parameter>& info) {
  return std::string(std::get<0>(info.param).name) + (std::get<1>(info.param) ? "OnTheWorld" : "OnANode");
}

}  // namespace flexarm::test
