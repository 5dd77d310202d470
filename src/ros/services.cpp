#include "services.h"

#include <flexarm/ApplyWrench.h>
#include <flexarm/LoadState.h>
#include <flexarm/SaveState.h>
#include <flexarm/SetJointState.h>
#include <flexarm/SwitchMode.h>
#include <ros/console.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/checkpoint.h"
#include "flexarm/simulation/command_refusal.h"
#include "messages/conversions.h"
#include "node.h"
#include "payload_services.h"

namespace flexarm::node {
namespace {

bool pause(Node& simulator, std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  simulator.pause();
  return true;
}

bool resume(Node& simulator, std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  // std_srvs/Empty has no field for an error. An exception's text does reach the caller.
  if (!simulator.resume()) throw std::runtime_error("not resumed: " + simulator.run().failure);
  return true;
}

bool reset(Node& simulator, std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  simulator.reset();
  return true;
}

bool reset_with_clock(Node& simulator, std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.message = simulator.reset_with_clock();
  response.success = response.message.empty();
  return true;
}

bool reload(Node& simulator, std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  try {
    simulator.reload();
    response.success = true;
    response.message = "scene '" + simulator.simulation().scene().name + "'";
  } catch (const std::exception& error) {
    response.message = error.what();
    ROS_WARN_STREAM("~reload: the scene was not changed: " << error.what());
  }
  return true;
}

bool save_state(Node& simulator, SaveState::Request& request, SaveState::Response& response) {
  simulator.catch_up();
  try {
    write_checkpoint(simulator.simulation(), request.file);
    response.success = true;
    response.message = std::filesystem::absolute(request.file);
  } catch (const std::runtime_error& error) {
    response.message = error.what();
  }
  response.time = simulator.simulation().time();
  return true;
}

bool load_state(Node& simulator, LoadState::Request& request, LoadState::Response& response) {
  try {
    simulator.load_state(request.file);
    response.success = true;
  } catch (const std::runtime_error& error) {
    response.message = error.what();
  }
  response.time = simulator.simulation().time();
  return true;
}

bool set_joint_state(Node& simulator, SetJointState::Request& request, SetJointState::Response& response) {
  const std::size_t count = request.names.size();
  for (const std::vector<double>* values : {&request.positions, &request.velocities}) {
    if (values->empty() || values->size() == count) continue;
    response.message = std::to_string(count) + " names, but " + std::to_string(values->size()) +
                       (values == &request.positions ? " positions" : " velocities");
    return true;
  }
  std::vector<CoordinateState> coordinates;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<std::size_t> coordinate = simulator.simulation().find_coordinate(request.names[i]);
    if (!coordinate) {
      response.message = unknown_coordinate(simulator.simulation(), request.names[i]);
      return true;
    }
    CoordinateState& wanted = coordinates.emplace_back();
    wanted.coordinate = *coordinate;
    if (!request.positions.empty()) wanted.position = request.positions[i];
    if (!request.velocities.empty()) wanted.velocity = request.velocities[i];
  }
  try {
    simulator.set_joint_state(coordinates);
    response.success = true;
  } catch (const std::invalid_argument& error) {
    response.message = error.what();
  }
  return true;
}

bool switch_mode(Node& simulator, SwitchMode::Request& request, SwitchMode::Response& response) {
  response.message = simulator.switch_mode(request.names, request.modes);
  response.success = response.message.empty();
  return true;
}

bool apply_wrench(Node& simulator, ApplyWrench::Request& request, ApplyWrench::Response& response) {
  const std::vector<std::string>& links = simulator.simulation().link_names();
  const auto link = std::find(links.begin(), links.end(), request.link);
  if (link == links.end()) {
    response.message = "there is no link '" + request.link + "'";
  } else if (request.frame != "" && request.frame != "world" && request.frame != "follower") {
    response.message = "frame must be 'world' or 'follower', got '" + request.frame + "'";
  } else {
    const AppliedWrench wrench{static_cast<std::size_t>(link - links.begin()),
                               messages::to_vector(request.point),
                               {messages::to_vector(request.wrench.force), messages::to_vector(request.wrench.torque)},
                               request.frame == "follower"};
    try {
      simulator.apply_wrench(wrench, request.start, request.duration.toSec());
      response.success = true;
    } catch (const std::invalid_argument& error) {
      response.message = error.what();
    }
  }
  return true;
}

bool clear_wrenches(Node& simulator, std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  simulator.clear_wrenches();
  return true;
}

template <class Request, class Response>
ros::ServiceServer serve(ros::NodeHandle& private_node, const std::string& name, Node& simulator,
                         bool (*answer)(Node&, Request&, Response&)) {
  const boost::function<bool(Request&, Response&)> callback =
      [&simulator, answer](Request& request, Response& response) { return answer(simulator, request, response); };
  return private_node.advertiseService(name, callback);
}

}  // namespace

Services::Services(ros::NodeHandle& private_node, Node& simulator) {
  const auto add = [&](const std::string& name, auto answer) {
    servers_.push_back(serve(private_node, name, simulator, answer));
  };
  add("pause", pause);
  add("resume", resume);
  add("reset", reset);
  add("reset_with_clock", reset_with_clock);
  add("reload", reload);
  add("save_state", save_state);
  add("load_state", load_state);
  add("set_joint_state", set_joint_state);
  add("switch_mode", switch_mode);
  add("apply_wrench", apply_wrench);
  add("clear_wrenches", clear_wrenches);
  for (ros::ServiceServer& server : serve_payloads(private_node, simulator)) servers_.push_back(server);
  step_service_.emplace(private_node, simulator);  // the last one: a client that waits for it finds the others
}

std::vector<std::string> Services::names() const {
  std::vector<std::string> names = {step_service_->server().getService()};
  for (const ros::ServiceServer& server : servers_) names.push_back(server.getService());
  return names;
}

}  // namespace flexarm::node
