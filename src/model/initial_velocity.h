#pragma once
/// The velocity field at the start, from joint rates and links' rigid velocity fields (internal to model/).

#include <map>
#include <vector>

#include "joints/joint_kinematics.h"
#include "mechanism_builder.h"

namespace flexarm {

/// Root to leaf: every link moves rigidly with its joint, unless the scene gives it a field of its own. Then the joints
/// that close loops take the nodes that they hold along; what that changes is a rate of deformation of their beams.
class InitialVelocity {
 public:
  InitialVelocity(const scene::SceneDescription& scene, MechanismBuilder& mechanism);
  /// Sets Model::initial_velocity.
  /// @throws ModelError where a rigid link's joints do not allow its field.
  void set();

 private:
  using JointRecord = MechanismBuilder::JointRecord;

  void set_joint(const JointRecord& record);
  void set_beam(int link);
  /// Rates of a joint that closes a loop: as given, else what leaves its slave's velocity least changed.
  void set_loop(const JointRecord& record);
  /// Lets every slave follow once more, those of closing joints included.
  void close_loops();
  /// Gives rates about which the scene is silent the least values with which loops of rigid links stay closed.
  void satisfy_closures();
  bool is_given(const Coordinate& coordinate) const;
  /// Velocity of a joint's slave from its master's.
  void follow(int joint, const ReleasedVector& rates);
  double mimic_ratio(const Coordinate& coordinate) const;
  /// Rates that the scene gives or implies (motion, mimic); false if none is given.
  bool given_rates(const JointRecord& record, ReleasedVector& rates) const;
  double given_rate(const Coordinate& coordinate, bool& is_given) const;
  /// Least-squares rates for the velocity that the child's field asks of the joint's last slave.
  ReleasedVector field_rates(const JointRecord& record, const Vector6& target);
  Vector6 field_velocity(const scene::InitialLink& field, int link, const Vector3& point) const;
  void check_field(const scene::InitialLink& field, int link) const;

  const scene::SceneDescription& scene_;
  MechanismBuilder& mechanism_;
  Model& model_;
  std::map<int, const scene::InitialLink*> fields_;  // by link
  std::map<std::string, double> initial_rates_;      // by coordinate, as the scene gives them
  std::map<int, double> field_rates_;                // by coordinate: what a field gave, for mimics further out
  std::vector<int> joint_of_;                        // by node: the joint of the tree of which it is the slave, or -1
  std::vector<ReleasedVector> rates_;                // by joint
};

}  // namespace flexarm
