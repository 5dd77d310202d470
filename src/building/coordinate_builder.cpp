#include "building/passes.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "building/elementary_joints.h"
#include "building/model_builder.h"
#include "joints/kinematics.h"

namespace flexarm {
namespace {

/// Coordinates of a mechanism by name.
class CoordinateNames {
 public:
  explicit CoordinateNames(const Model& model) : closures_(model.closures) {
    for (std::size_t i = 0; i < model.coordinates.size(); ++i)
      indices_.emplace(model.coordinates[i].name, static_cast<int>(i));
  }
  /// `where`: the beginning of the error message if there is no such coordinate.
  int index(const std::string& name, const std::string& where) const {
    if (const auto found = indices_.find(name); found != indices_.end()) return found->second;
    for (const LoopClosure& closure : closures_)
      if (name.substr(0, closure.name.size()) == closure.name)
        throw ModelError(where + "joint '" + closure.name +
                         "' closes a loop of rigid links and has no coordinate: name another joint of the loop, "
                         "or make another joint the loop joint");
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
      const scene::Mimic above = next->second;  // a copy, since `next` may be this very mimic
      mimic.offset += mimic.multiplier * above.offset;
      mimic.multiplier *= above.multiplier;
      mimic.joint = above.joint;
    }
    return mimic;
  }

 private:
  std::unordered_map<std::string, scene::Mimic> mimics_;  // by joint; if resolved, of the coordinate at the chain's end
};

/// Places all nodes as the initial positions of their joints require.
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

/// The coordinate's actuator, which is made if there is none yet.
Actuator& actuator_of(int coordinate, Model& model) {
  int& index = model.coordinates[coordinate].actuator;
  if (index < 0) {
    index = static_cast<int>(model.actuators.size());
    model.actuators.emplace_back().coordinate = coordinate;
  }
  return model.actuators[index];
}

/// Index of a coordinate by its name, for elements that act on hinges and sliders.
/// @throws ModelError if it is one of several coordinates of an elementary joint, or follows another coordinate
int scalar_coordinate(const Model& model, const CoordinateNames& names, const std::string& name,
                      const std::string& where) {
  const int index = names.index(name, where);
  const Coordinate& coordinate = model.coordinates[index];
  if (released_count(model.joints[coordinate.joint].kind) != 1)
    throw ModelError(where + "'" + name +
                     "' is one of several coordinates that turn or fly freely; name a hinge or a slider");
  if (coordinate.mimicked >= 0) throw ModelError(where + "'" + name + "' follows another coordinate; name that one");
  return index;
}

void add_spring(const scene::SpringDescription& spring, const CoordinateNames& names, Model& model) {
  const int index = scalar_coordinate(model, names, spring.coordinate, at(spring.location, "<spring>"));
  actuator_of(index, model).spring = JointSpring{{spring.stiffness, 0, 0}, spring.rest};
}

/// The joint of the scene that has the coordinate.
const scene::JointDescription& joint_of(const scene::SceneDescription& scene, const std::string& coordinate) {
  for (const auto* joints : {&scene.joints, &scene.loop_joints})
    for (const scene::JointDescription& joint : *joints)
      for (const std::string& name : coordinate_names(joint))
        if (name == coordinate) return joint;
  throw ModelError("there is no joint coordinate '" + coordinate + "'");
}

void add_gyroscope(const ScenePlan& plan, const scene::DriveDescription& drive, Actuator& actuator, Model& model) {
  const std::string where = at(drive.location, "<drive>");
  const JointMap& map = model.joints[model.coordinates[actuator.coordinate].joint];
  const scene::JointDescription& joint = joint_of(plan.scene, drive.coordinate);
  if (actuator.drive.sticks)
    throw ModelError(where + "the rotor of '" + drive.coordinate +
                     "' may stick by the law 'coulomb' or have an axis, but not both");
  const Attachment parent = attachment(plan, model, joint.parent, joint.origin.position);
  if (parent.node < 0) return;  // the axis stands still
  if (map.kind != JointMapKind::Scalar || map.master != parent.node)
    throw ModelError(where + "the axis of a rotor is not known, since no hinge or slider is mounted on link '" +
                     joint.parent + "'; leave it out");
  actuator.gyroscope =
      Gyroscope{parent.node, parent.offset.orientation * *drive.axis, drive.rotor_inertia, drive.gear.value_or(1)};
}

void add_drive(const ScenePlan& plan, const scene::DriveDescription& drive, const CoordinateNames& names,
               Model& model) {
  const std::string where = at(drive.location, "<drive>");
  const int index = scalar_coordinate(model, names, drive.coordinate, where);
  Coordinate& coordinate = model.coordinates[index];
  if (coordinate.motion >= 0) throw ModelError(where + "the motion of '" + drive.coordinate + "' is prescribed");
  Drive& out = actuator_of(index, model).drive;
  const double gear = drive.gear.value_or(1);
  out.inertia = gear * gear * drive.rotor_inertia;
  out.loss = 1 / drive.efficiency - 1;
  if (drive.effort_limit > 0) out.effort_limit = drive.effort_limit;
  if (drive.velocity_limit > 0) out.velocity_limit = drive.velocity_limit;
  if (drive.stiffness) {
    out.gear = Elasticity{*drive.stiffness, drive.damping, drive.backlash};
    out.friction = drive.friction;
    out.sticks = coordinate.sticks;
  } else {
    coordinate.friction += drive.friction;
  }
  if (drive.axis && drive.rotor_inertia > 0) add_gyroscope(plan, drive, actuator_of(index, model), model);
}

/// In velocity mode, the integral of the error is like a position error: so ki is the proportional gain, and kp the
/// derivative gain.
ServoLaw servo_law(const scene::ServoDescription::Gains& gains) {
  if (gains.mode == ServoMode::Velocity) return {gains.mode, gains.ki, gains.kp, 0, gains.anti_windup};
  return {gains.mode, gains.kp, gains.kd, gains.ki, gains.anti_windup};
}

void add_servo(const ScenePlan& plan, const scene::ServoDescription& servo, const CoordinateNames& names,
               Model& model) {
  const std::string where = at(servo.location, "<servo>");
  const int index = scalar_coordinate(model, names, servo.coordinate, where);
  const Coordinate& coordinate = model.coordinates[index];
  if (coordinate.motion >= 0) throw ModelError(where + "the motion of '" + servo.coordinate + "' is prescribed");
  if (!hits_samples(plan.scene.integrator.step, servo.sample_time))
    throw ModelError(fmt::format("{}sample_time must be a multiple of the step, {} s, got '{}'", where,
                                 plan.scene.integrator.step, servo.sample_time));
  Actuator& actuator = actuator_of(index, model);
  Servo& out = actuator.servo.emplace();
  out.laws.push_back(servo_law({servo.mode, servo.kp, servo.kd, servo.ki, servo.anti_windup}));
  for (const scene::ServoDescription::Gains& gains : servo.other_modes) out.laws.push_back(servo_law(gains));
  if (servo.mode != ServoMode::Effort) out.laws.push_back(servo_law({ServoMode::Effort}));  // this mode needs no gains
  if (servo.set_point) out.set_point = add_history(*servo.set_point, model);
  if (servo.feedforward) out.feedforward = add_history(*servo.feedforward, model);
  if (servo.mode == ServoMode::Position)
    out.start = model.initial_released[coordinate.joint].displacement[coordinate.component % 3];
  if (servo.effort_limit > 0) out.effort_limit = servo.effort_limit;
  out.on_link = servo.side == scene::ServoDescription::Side::Link || !actuator.drive.gear;
  out.sample_time = servo.sample_time;
  out.delay = servo.delay;
}

}  // namespace

TreeAtStart follow_mimics(const ScenePlan& plan, MassiveTree tree) {
  Model& model = tree.model;
  const CoordinateNames names(model);
  MimicChains chains(tree.tree_joints);
  std::unordered_set<std::string> prescribed;
  for (const scene::PrescribedMotion& motion : plan.scene.motions) prescribed.insert(motion.coordinate);
  std::unordered_set<std::string> fixed;
  for (const scene::JointDescription& joint : plan.scene.joints)
    if (joint.kind == scene::JointKind::Fixed) fixed.insert(joint.name);
  for (const JointChain& chain : tree.tree_joints) {
    if (!chain.joint->mimic) continue;
    const std::string& joint = chain.joint->name;
    const std::string where = at(chain.joint->location, "<mimic> of joint '" + joint + "'");
    const scene::Mimic mimic = chains.resolved(joint, where);
    if (fixed.count(mimic.joint) > 0 && prescribed.count(joint) > 0) continue;  // its motion says where it is held
    Coordinate& coordinate = model.coordinates[names.index(joint, where)];
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
  for (const scene::SpringDescription& spring : plan.scene.springs) add_spring(spring, names, model);
  for (const scene::DriveDescription& drive : plan.scene.drives) add_drive(plan, drive, names, model);
  for (const scene::ServoDescription& servo : plan.scene.servos) add_servo(plan, servo, names, model);
  return {std::move(mechanism)};
}

// ---------------------------------------------------------------- stops

namespace {

/// Depth by which a stop gives way at most, relative to the range of the coordinate.
constexpr double kDepth = 0.1;
/// The same if there is no range: in rad, or relative to the size of the mechanism.
constexpr double kDepthWithoutRange = 1e-4;
/// A start beyond a stop is at most this part of the depth, over which the stop is nearly linear.
constexpr double kShareOfStart = 0.25;

void deepen(double& give, double start) {
  give = std::max(give, start / kShareOfStart);
}

}  // namespace

void set_stop_depths(Model& model) {
  for (Coordinate& coordinate : model.coordinates) {
    if (!coordinate.limit) continue;
    LimitStop& stop = *coordinate.limit;
    const JointMap& joint = model.joints[coordinate.joint];
    if (joint.kind == JointMapKind::Slide) {
      const SlideLine& line = model.slide_lines[joint.line];
      stop.give_below = SlideLine::kLargestOvershoot * line.pieces.front().length();
      stop.give_above = SlideLine::kLargestOvershoot * line.pieces.back().length();
      continue;
    }
    const double range = stop.upper - stop.lower,
                 start = model.initial_released[coordinate.joint].displacement[coordinate.component];
    stop.give_below = stop.give_above =
        range > 0 ? kDepth * range : kDepthWithoutRange * coordinate_scale(model, coordinate);
    deepen(stop.give_below, stop.lower - start);
    deepen(stop.give_above, start - stop.upper);
  }
}

// ---------------------------------------------------------------- damping ratios

namespace {

/// The actuator of a coordinate, which must have one.
Actuator& actuator_named(const std::string& coordinate, Model& model) {
  const auto is_its = [&](const Actuator& actuator) {
    return model.coordinates[actuator.coordinate].name == coordinate;
  };
  return *std::find_if(model.actuators.begin(), model.actuators.end(), is_its);
}

/// `where`: the beginning of the error message if the inertia is not known.
double damper(double ratio, double stiffness, double inertia, const std::string& where) {
  if (inertia > 0) return 2 * ratio * std::sqrt(stiffness * inertia);
  throw ModelError(
      where +
      "damping_ratio needs the inertia that the joint moves, which is not known in mechanisms with loops (except "
      "in loops of rigid links), on slides, and where other joints follow it; give the damping itself, that of the "
      "joint's <dynamics> or "
      "of the gear");
}

}  // namespace

void set_damping_ratios(const scene::SceneDescription& scene, const std::vector<int>& node_parents, Model& model) {
  const auto has_ratio = [](const auto& description) { return description.damping_ratio > 0; };
  if (std::none_of(scene.springs.begin(), scene.springs.end(), has_ratio) &&
      std::none_of(scene.drives.begin(), scene.drives.end(), has_ratio))
    return;
  std::vector<double> inertias = articulated_inertias(node_parents, model);
  std::vector<bool> is_asked(inertias.size(), false);
  for (const Actuator& actuator : model.actuators) is_asked[actuator.coordinate] = true;
  const std::vector<InLoops> in_loops = loop_inertias(node_parents, model, is_asked);
  for (std::size_t i = 0; i < inertias.size(); ++i)
    if (in_loops[i].inertia > 0) inertias[i] = in_loops[i].inertia;
  const auto set = [&](const auto& description, Elasticity& elasticity, int coordinate, const char* element) {
    elasticity.damping = damper(description.damping_ratio, elasticity.stiffness, inertias[coordinate],
                                at(description.location, element));
  };
  for (const scene::SpringDescription& spring : scene.springs) {
    Actuator& actuator = actuator_named(spring.coordinate, model);
    if (has_ratio(spring)) set(spring, actuator.spring->elasticity, actuator.coordinate, "<spring>");
  }
  for (const scene::DriveDescription& drive : scene.drives) {
    Actuator& actuator = actuator_named(drive.coordinate, model);
    if (has_ratio(drive)) set(drive, *actuator.drive.gear, actuator.coordinate, "<drive>");
  }
}

}  // namespace flexarm
