#include "controller_parameters.h"

#include <ros/names.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/command_refusal.h"
#include "parameters.h"

namespace flexarm::node {
namespace {

using XmlRpc::XmlRpcValue;
using Type = ControllerDescription::Type;

constexpr const char* kOfAll = "follow_joint_trajectory";

/// Reads the entries of the list one by one, and collects all errors.
class ControllerReader {
 public:
  ControllerReader(std::string parameter, const Simulation& simulation)
      : parameter_(std::move(parameter)), simulation_(simulation) {}

  void read_list(XmlRpcValue value) {
    if (value.getType() == XmlRpcValue::TypeStruct && value.hasMember("controller_list")) {
      value = XmlRpcValue(value["controller_list"]);
      parameter_ += "/controller_list";
    }
    if (value.getType() != XmlRpcValue::TypeArray)
      return add_error(parameter_ + ": must be a list of controllers, or a dictionary with a 'controller_list'");
    for (int i = 0; i < value.size(); ++i) {
      place_ = fmt::format("{}, entry {}", parameter_, i + 1);
      if (value[i].getType() == XmlRpcValue::TypeStruct)
        read_controller(value[i]);
      else
        complain("must be a dictionary with name, action_ns, type and joints");
    }
  }

  std::vector<ControllerDescription> take() {
    if (!errors_.empty()) throw ParameterError("controllers that cannot be used:\n" + errors_);
    return std::move(controllers_);
  }

 private:
  void read_controller(XmlRpcValue& entry) {
    ControllerDescription out;
    std::string action, type;
    const bool has_name = read_text(entry, "name", out.name);
    if (has_name) place_ += " ('" + out.name + "')";
    const bool has_action = read_text(entry, "action_ns", action), has_type = read_text(entry, "type", type);
    if (!read_joints(entry, out) || !has_name || !has_action || !has_type) return;
    out.action = out.name.empty() ? action : action.empty() ? out.name : out.name + "/" + action;
    std::string fault;
    if (out.action.empty() || !ros::names::validate(out.action, fault))
      return complain("'" + out.action + "' is not a name of an action: name/action_ns " + fault);
    for (const ControllerDescription& other : controllers_)
      if (other.action == out.action) return complain("another controller has the action '" + out.action + "'");
    if (type == "GripperCommand")
      read_gripper(entry, out);
    else if (type != "FollowJointTrajectory")
      return complain("type must be 'FollowJointTrajectory' or 'GripperCommand', got '" + type + "'");
    check_joints(out);
    controllers_.push_back(out);
  }

  bool read_text(XmlRpcValue& entry, const char* field, std::string& value) {
    const bool is_text = entry.hasMember(field) && entry[field].getType() == XmlRpcValue::TypeString;
    if (is_text)
      value = static_cast<std::string>(entry[field]);
    else
      complain(entry.hasMember(field) ? fmt::format("its '{}' must be text", field)
                                      : fmt::format("it has no '{}'", field));
    return is_text;
  }

  bool read_joints(XmlRpcValue& entry, ControllerDescription& out) {
    if (!entry.hasMember("joints")) return complain("it has no 'joints'"), false;
    XmlRpcValue& joints = entry["joints"];
    bool are_names = joints.getType() == XmlRpcValue::TypeArray && joints.size() > 0;
    for (int i = 0; are_names && i < joints.size(); ++i) {
      are_names = joints[i].getType() == XmlRpcValue::TypeString;
      if (are_names) out.joints.push_back(joints[i]);
    }
    if (!are_names) complain("its 'joints' must be a list of names, with one at least");
    return are_names;
  }

  void read_number(XmlRpcValue& entry, const char* field, double& value) {
    if (!entry.hasMember(field)) return;
    XmlRpcValue& given = entry[field];
    double number = NAN;
    if (given.getType() == XmlRpcValue::TypeInt)
      number = static_cast<int>(given);
    else if (given.getType() == XmlRpcValue::TypeDouble)
      number = static_cast<double>(given);
    if (std::isfinite(number) && number >= 0)
      value = number;
    else
      complain(fmt::format("its '{}' must be a number >= 0", field));
  }

  void read_gripper(XmlRpcValue& entry, ControllerDescription& out) {
    out.type = Type::GripperCommand;
    read_number(entry, "max_effort", out.max_effort);
    read_number(entry, "goal_tolerance", out.goal_tolerance);
    read_number(entry, "stall_velocity_threshold", out.stall_velocity);
    read_number(entry, "stall_timeout", out.stall_timeout);
    if (out.joints.size() > 2)
      complain(fmt::format("a gripper has one joint or two, got {} in 'joints'", out.joints.size()));
    if (entry.hasMember("parallel")) {
      if (entry["parallel"].getType() != XmlRpcValue::TypeBoolean)
        return complain("its 'parallel' must be true or false");
      out.is_parallel = entry["parallel"];
      if (out.is_parallel && out.joints.size() != 2) complain("'parallel' is for two joints");
    }
    out.command_joint = out.joints.front();
    if (entry.hasMember("command_joint") && read_text(entry, "command_joint", out.command_joint) &&
        std::find(out.joints.begin(), out.joints.end(), out.command_joint) == out.joints.end())
      complain("its 'command_joint' is not one of its joints, got '" + out.command_joint + "'");
  }

  /// Checks that each joint exists, has a servo to drive it, and belongs to one controller only.
  void check_joints(const ControllerDescription& controller) {
    for (const std::string& name : controller.joints) {
      const std::optional<std::size_t> joint = simulation_.find_coordinate(name);
      if (!joint) {
        complain(unknown_coordinate(simulation_, name));
        continue;
      }
      const auto [owner, is_first] = owners_.emplace(name, controller.name);
      if (!is_first)
        complain("joint '" + name + "' is named twice" +
                 (owner->second == controller.name ? "" : ", in '" + owner->second + "' as well"));
      const bool may_follow = controller.type == Type::GripperCommand;
      const std::size_t driven = may_follow ? driven_by(simulation_, name).coordinate : *joint;
      if (const std::string refusal = refusal_of_set_points(simulation_, driven); !refusal.empty()) complain(refusal);
    }
  }

  void complain(const std::string& what) { add_error(place_ + ": " + what); }
  void add_error(const std::string& error) { errors_ += (errors_.empty() ? "" : "\n") + error; }

  std::string parameter_, place_, errors_;
  const Simulation& simulation_;
  std::vector<ControllerDescription> controllers_;
  std::map<std::string, std::string> owners_;  ///< names of controllers, by joint name
};

}  // namespace

DrivenBy driven_by(const Simulation& simulation, const std::string& joint) {
  const std::optional<std::size_t> coordinate = simulation.find_coordinate(joint);
  if (!coordinate) throw std::invalid_argument(unknown_coordinate(simulation, joint));
  for (const scene::JointDescription& description : simulation.scene().joints) {
    if (description.name != joint || !description.mimic) continue;
    const scene::Mimic& mimic = *description.mimic;
    const DrivenBy leader = driven_by(simulation, mimic.joint);
    return {leader.coordinate, mimic.multiplier * leader.multiplier, mimic.multiplier * leader.offset + mimic.offset};
  }
  return {*coordinate};
}

std::vector<ControllerDescription> read_controllers(const ros::NodeHandle& private_node, const Simulation& simulation) {
  ControllerReader reader(private_node.resolveName("controllers"), simulation);
  XmlRpcValue value;
  if (private_node.getParam("controllers", value)) reader.read_list(value);
  std::vector<ControllerDescription> controllers = reader.take();
  const bool is_free = std::none_of(controllers.begin(), controllers.end(),
                                    [](const ControllerDescription& one) { return one.action == kOfAll; });
  if (is_free) {
    ControllerDescription of_all;
    of_all.action = kOfAll;
    controllers.push_back(of_all);
  }
  return controllers;
}

}  // namespace flexarm::node
