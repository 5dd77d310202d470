#include "services.h"

#include <ros/console.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/checkpoint.h"
#include "messages/conversions.h"
#include "node.h"

namespace flexarm::node {

constexpr std::uint32_t kMostSteps = 1000000;  ///< of one call: nothing else is served meanwhile

Services::Services(ros::NodeHandle& private_node, Node& simulator) : simulator_(simulator) {
  servers_ = {private_node.advertiseService("pause", &Services::pause, this),
              private_node.advertiseService("resume", &Services::resume, this),
              private_node.advertiseService("reset", &Services::reset, this),
              private_node.advertiseService("reset_with_clock", &Services::reset_with_clock, this),
              private_node.advertiseService("reload", &Services::reload, this),
              private_node.advertiseService("step", &Services::step, this),
              private_node.advertiseService("save_state", &Services::save_state, this),
              private_node.advertiseService("load_state", &Services::load_state, this),
              private_node.advertiseService("set_joint_state", &Services::set_joint_state, this),
              private_node.advertiseService("switch_mode", &Services::switch_mode, this),
              private_node.advertiseService("apply_wrench", &Services::apply_wrench, this),
              private_node.advertiseService("clear_wrenches", &Services::clear_wrenches, this)};
}

std::vector<std::string> Services::names() const {
  std::vector<std::string> names;
  for (const ros::ServiceServer& server : servers_) names.push_back(server.getService());
  return names;
}

bool Services::pause(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  simulator_.pause();
  return true;
}

bool Services::resume(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  // An exception's text reaches the caller, an answer without fields has no place for it.
  if (!simulator_.resume()) throw std::runtime_error("not resumed: " + simulator_.run().failure);
  return true;
}

bool Services::reset(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  simulator_.reset();
  return true;
}

bool Services::reset_with_clock(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.message = simulator_.reset_with_clock();
  response.success = response.message.empty();
  return true;
}

bool Services::reload(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  try {
    simulator_.reload();
    response.success = true;
    response.message = "scene '" + simulator_.simulation().scene().name + "'";
  } catch (const std::exception& error) {
    response.message = error.what();
    ROS_WARN_STREAM("~reload: the scene stays as it was: " << error.what());
  }
  return true;
}

bool Services::step(Step::Request& request, Step::Response& response) {
  if (!simulator_.run().paused) {
    response.message = "the simulation runs; pause it first";
  } else if (request.steps > kMostSteps) {
    response.message = "more than " + std::to_string(kMostSteps) + " steps at once";
  } else {
    response.success = simulator_.step(request.steps);
    if (!response.success) response.message = simulator_.run().failure;
  }
  response.time = simulator_.simulation().time();
  return true;
}

bool Services::save_state(SaveState::Request& request, SaveState::Response& response) {
  simulator_.catch_up();
  try {
    write_checkpoint(simulator_.simulation(), request.file);
    response.success = true;
    response.message = std::filesystem::absolute(request.file);
  } catch (const std::runtime_error& error) {
    response.message = error.what();
  }
  response.time = simulator_.simulation().time();
  return true;
}

bool Services::load_state(LoadState::Request& request, LoadState::Response& response) {
  try {
    simulator_.load_state(request.file);
    response.success = true;
  } catch (const std::runtime_error& error) {
    response.message = error.what();
  }
  response.time = simulator_.simulation().time();
  return true;
}

bool Services::set_joint_state(SetJointState::Request& request, SetJointState::Response& response) {
  const std::size_t count = request.names.size();
  for (const std::vector<double>* values : {&request.positions, &request.velocities}) {
    if (values->empty() || values->size() == count) continue;
    response.message = std::to_string(count) + " names, but " + std::to_string(values->size()) +
                       (values == &request.positions ? " positions" : " velocities");
    return true;
  }
  std::vector<CoordinateState> coordinates;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<std::size_t> coordinate = simulator_.simulation().find_coordinate(request.names[i]);
    if (!coordinate) {
      response.message = "there is no joint coordinate '" + request.names[i] + "'";
      return true;
    }
    CoordinateState& wanted = coordinates.emplace_back();
    wanted.coordinate = *coordinate;
    if (!request.positions.empty()) wanted.position = request.positions[i];
    if (!request.velocities.empty()) wanted.velocity = request.velocities[i];
  }
  try {
    simulator_.set_joint_state(coordinates);
    response.success = true;
  } catch (const std::invalid_argument& error) {
    response.message = error.what();
  }
  return true;
}

bool Services::switch_mode(SwitchMode::Request& request, SwitchMode::Response& response) {
  response.message = simulator_.switch_mode(request.names, request.modes);
  response.success = response.message.empty();
  return true;
}

bool Services::apply_wrench(ApplyWrench::Request& request, ApplyWrench::Response& response) {
  const std::vector<std::string>& links = simulator_.simulation().link_names();
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
      simulator_.apply_wrench(wrench, request.start, request.duration.toSec());
      response.success = true;
    } catch (const std::invalid_argument& error) {
      response.message = error.what();
    }
  }
  return true;
}

bool Services::clear_wrenches(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  simulator_.clear_wrenches();
  return true;
}

}  // namespace flexarm::node
