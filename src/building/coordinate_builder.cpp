#include "building/coordinate_builder.h"

#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "building/model_builder.h"
#include "joints/joint_kinematics.h"

namespace flexarm {
namespace {

/// Coordinates of a mechanism by name.
class CoordinateNames {
 public:
  explicit CoordinateNames(const Model& model) : closures_(model.closures) {
    for (std::size_t i = 0; i < model.coordinates.size(); ++i)
      indices_.emplace(model.coordinates[i].name, static_cast<int>(i));
  }
  /// `where`: begins the message if there is none.
  int index(const std::string& name, const std::string& where) const {
    if (const auto found = indices_.find(name); found != indices_.end()) return found->second;
    for (const LoopClosure& closure : closures_)
      if (name.substr(0, closure.name.size()) == closure.name)
        throw ModelError(where + "joint '" + closure.name +
                         "' closes a loop of rigid links and has no coordinate there: name another joint of the loop, "
                         "or cut it there");
    throw ModelError(where + "there is no joint coordinate '" + name + "'");
  }

 private:
  const std::vector<LoopClosure>& closures_;
  std::unordered_map<std::string, int> indices_;
};

/// Follows chains of joints that mimic each other.
class MimicChains {
 public:
  explicit MimicChains(const std::vector<JointChain>& joints) {
    for (const JointChain& chain : joints)
      if (chain.joint->mimic) mimics_[chain.joint->name] = *chain.joint->mimic;
  }
  /// The law by which a joint follows the one at the end of its chain, which mimics none.
  scene::Mimic resolved(const std::string& joint, const std::string& where) {
    scene::Mimic& mimic = mimics_.at(joint);
    std::size_t depth = 0;
    for (auto next = mimics_.find(mimic.joint); next != mimics_.end(); next = mimics_.find(mimic.joint)) {
      if (++depth > mimics_.size()) throw ModelError(where + "the mimicked joints form a circle");
      const scene::Mimic above = next->second;  // it may be the same one
      mimic.offset += mimic.multiplier * above.offset;
      mimic.multiplier *= above.multiplier;
      mimic.joint = above.joint;
    }
    return mimic;
  }

 private:
  std::unordered_map<std::string, scene::Mimic> mimics_;  // by joint; where known, of the coordinate at the chain's end
};

/// Puts nodes where initial_released has their slaves.
void place_nodes(Mechanism& mechanism) {
  Model& model = mechanism.model;
  std::vector<Pose> before;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) before.push_back(mechanism.pose_of(static_cast<int>(i)));
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (const int joint = mechanism.slave_joint[i]; joint >= 0) {
      model.nodes[i] = slave_pose(model, joint, model.nodes, model.initial_released[joint]);
    } else {
      const int parent = mechanism.node_parents[i];
      const Pose pose = mechanism.pose_of(parent) * (before[parent].inverse() * before[i]);
      model.nodes[i].position = pose.position;
      model.nodes[i].orientation = pose.orientation;
      model.nodes[i].rotation = pose.orientation.toRotationMatrix();
    }
  }
}

int add_history(const TimeFunction& function, Model& model) {
  model.histories.push_back(function);
  return static_cast<int>(model.histories.size()) - 1;
}

}  // namespace

TreeAtStart follow_mimics(const ScenePlan& plan, MassiveTree tree) {
  Model& model = tree.model;
  const CoordinateNames names(model);
  MimicChains chains(tree.tree_joints);
  std::unordered_set<std::string> prescribed;
  for (const scene::PrescribedMotion& motion : plan.scene.motions) prescribed.insert(motion.coordinate);
  for (const JointChain& chain : tree.tree_joints) {
    if (!chain.joint->mimic) continue;
    const std::string& joint = chain.joint->name;
    const std::string where = at(chain.joint->location, "<mimic> of joint '" + joint + "'");
    Coordinate& coordinate = model.coordinates[names.index(joint, where)];
    const scene::Mimic mimic = chains.resolved(joint, where);
    if (prescribed.count(coordinate.name) > 0)
      throw ModelError(where + "the motion of the joint is prescribed as well");
    coordinate.mimicked = names.index(mimic.joint, where);
    coordinate.mimic.multiplier = mimic.multiplier;
    coordinate.mimic.offset = mimic.offset;
    coordinate.limit.reset();
    const Coordinate& base = model.coordinates[coordinate.mimicked];
    if (model.joints[base.joint].kind != JointMapKind::Scalar)
      throw ModelError(where + "only a joint with one coordinate can be mimicked");
    model.initial_released[coordinate.joint].displacement[0] =
        coordinate.mimic.value(model.initial_released[base.joint].displacement[0]);
  }
  place_nodes(tree);
  return {std::move(tree)};
}

DrivenMechanism connect_drives(const ScenePlan& plan, ClosedMechanism mechanism) {
  Model& model = mechanism.model;
  const CoordinateNames names(model);
  for (const scene::InitialJoint& initial : plan.scene.initial_joints)
    names.index(initial.coordinate, at(initial.location, "<initial>"));
  for (const scene::PrescribedMotion& motion : plan.scene.motions) {
    const std::string where = at(motion.location, "<motion>");
    Coordinate& coordinate = model.coordinates[names.index(motion.coordinate, where)];
    if (coordinate.is_angle)
      throw ModelError(where + "a component of a free rotation cannot be prescribed ('" + motion.coordinate + "')");
    coordinate.motion = add_history(motion.position, model);
    coordinate.limit.reset();
  }
  for (const scene::JointEffort& effort : plan.scene.efforts)
    model.coordinates[names.index(effort.coordinate, at(effort.location, "<effort>"))].effort =
        add_history(effort.history, model);
  return {std::move(mechanism)};
}

}  // namespace flexarm
