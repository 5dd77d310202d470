#include "parameters.h"

#include <ros/console.h>
#include <ros/param.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "flexarm/math/near_names.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/schemes/integrator_description.h"
#include "web/own_names.h"

namespace flexarm::node {
namespace {

/// All that is read here and elsewhere, and `view`, which the node sets. test/ros/parameters_test.py compares it with
/// the sources.
const std::vector<std::string> kParameterNames = {"clock_rate",
                                                  "command_timeout",
                                                  "controllers",
                                                  "diagnostic_period",
                                                  "error_window",
                                                  "frame_prefix",
                                                  "interactive",
                                                  "lock_step",
                                                  "marker_rate",
                                                  "markers",
                                                  "massless",
                                                  "max_catch_up",
                                                  "max_halvings",
                                                  "max_iterations",
                                                  "on_failure",
                                                  "parameters",
                                                  "paused",
                                                  "publish_clock",
                                                  "publish_rate",
                                                  "pull_damping",
                                                  "pull_stiffness",
                                                  "real_time_factor",
                                                  "realtime",
                                                  "recovery_wall_time",
                                                  "rho_infinity",
                                                  "scene",
                                                  "scheme",
                                                  "start",
                                                  "status_rate",
                                                  "step",
                                                  "stop_duration",
                                                  "tolerance",
                                                  "trail_duration",
                                                  "view",
                                                  "web",
                                                  "web_address",
                                                  "web_port",
                                                  "web_rate",
                                                  "xacro_args"};

/// Reads parameters one by one, and collects all errors.
class ParameterReader {
 public:
  explicit ParameterReader(const ros::NodeHandle& node) : node_(node) {}

  void read(const std::string& name, bool& value) { read_as(name, value, "true or false"); }
  void read(const std::string& name, std::string& value) { read_as(name, value, "text"); }

  void read(const std::string& name, double& value, bool zero_allowed = false) {
    double read_value = value;
    if (!read_as(name, read_value, "a number")) return;
    if (!std::isfinite(read_value) || read_value < 0 || (read_value == 0 && !zero_allowed)) {
      complain(name, zero_allowed ? "must be finite and >= 0" : "must be finite and > 0", std::to_string(read_value));
    } else {
      value = read_value;
    }
  }

  void read(const std::string& name, int& value, int minimum) {
    int read_value = value;
    if (!read_as(name, read_value, "a whole number")) return;
    if (read_value < minimum) {
      complain(name, "must be >= " + std::to_string(minimum), std::to_string(read_value));
    } else {
      value = read_value;
    }
  }

  /// Reads a dictionary of numbers.
  void read(const std::string& name, scene::ParameterValues& values) {
    XmlRpc::XmlRpcValue dictionary;
    if (!read_as(name, dictionary, "")) return;
    if (dictionary.getType() != XmlRpc::XmlRpcValue::TypeStruct)
      return complain(name, "must be a dictionary of numbers", dictionary.toXml());
    for (auto& [key, value] : dictionary) {
      if (value.getType() == XmlRpc::XmlRpcValue::TypeInt)
        values[key] = static_cast<int>(value);
      else if (value.getType() == XmlRpc::XmlRpcValue::TypeDouble)
        values[key] = static_cast<double>(value);
      else
        complain(name + "/" + key, "must be a number", value.toXml());
    }
  }

  void complain(const std::string& name, const std::string& expected, const std::string& got) {
    errors_ += (errors_.empty() ? "" : "\n") + node_.resolveName(name) + ": " + expected + ", got " + got;
  }

  void throw_if_any() const {
    if (!errors_.empty()) throw ParameterError("parameters that cannot be used:\n" + errors_);
  }

 private:
  template <typename Value>
  bool read_as(const std::string& name, Value& value, const std::string& expected) {
    if (!node_.hasParam(name)) return false;
    if (node_.getParam(name, value)) return true;
    XmlRpc::XmlRpcValue any;
    node_.getParam(name, any);
    complain(name, "must be " + expected, any.toXml());
    return false;
  }

  const ros::NodeHandle& node_;
  std::string errors_;
};

/// Follows the rule of tf_prefix and rviz, which join prefix and name with a slash: "left" and "left/" both turn the
/// frame "boom" into "left/boom".
void read_frame_prefix(ParameterReader& reader, std::string& prefix) {
  reader.read("frame_prefix", prefix);
  if (prefix.empty()) return;
  if (prefix.front() == '/') reader.complain("frame_prefix", "must not begin with a slash", "'" + prefix + "'");
  if (prefix.back() != '/') prefix += '/';
}

void read_on_failure(ParameterReader& reader, IntegratorDescription& integrator) {
  std::string choice;
  reader.read("on_failure", choice);
  if (choice.empty()) return;
  const std::optional<OnFailure> on_failure = on_failure_called(choice);
  if (!on_failure) return reader.complain("on_failure", "must be 'stop', 'dissipate' or empty", "'" + choice + "'");
  integrator.on_failure = *on_failure;
  for (const OptionConflict& conflict : option_conflicts(integrator))
    reader.complain("on_failure", conflict.message, "'" + choice + "'");
}

void override_integrator(const ros::NodeHandle& private_node, IntegratorDescription& integrator) {
  ParameterReader reader(private_node);
  std::string scheme = integrator.scheme;
  reader.read("scheme", scheme);
  integrator = with_scheme(integrator, scheme);
  reader.read("step", integrator.step);
  reader.read("tolerance", integrator.tolerance);
  reader.read("max_iterations", integrator.max_iterations, 1);
  reader.read("max_halvings", integrator.max_halvings, 0);
  if (private_node.hasParam("rho_infinity")) {
    double rho_infinity = 1;
    reader.read("rho_infinity", rho_infinity, true);
    if (rho_infinity > 1) reader.complain("rho_infinity", "must lie in [0, 1]", std::to_string(rho_infinity));
    integrator.rho_infinity = rho_infinity;
    for (const OptionConflict& conflict : option_conflicts(integrator))
      reader.complain("rho_infinity", conflict.message, std::to_string(rho_infinity));
  }
  read_on_failure(reader, integrator);
  reader.throw_if_any();
}

/// Reads a parameter that is either `choice` or empty. @returns whether it is `choice`
bool read_choice(ParameterReader& reader, const std::string& name, const std::string& choice) {
  std::string value;
  reader.read(name, value);
  if (!value.empty() && value != choice) reader.complain(name, "must be '" + choice + "' or empty", "'" + value + "'");
  return value == choice;
}

/// Reads words that are separated by commas. If the parameter is empty, all markers are shown.
void read_markers(ParameterReader& reader, messages::MarkerChoice& choice) {
  reader.read("trail_duration", choice.trail_duration);
  std::string choices;
  reader.read("markers", choices);
  if (choices.empty()) return;
  std::string known;
  for (const std::string& name : messages::MarkerChoice::names()) {
    *choice.find(name) = false;
    known += (known.empty() ? "'" : ", '") + name + "'";
  }
  std::stringstream words(choices);
  for (std::string word; std::getline(words, word, ',');) {
    bool* const member = choice.find(word);
    if (member)
      *member = true;
    else if (word != "none")
      reader.complain("markers", "must be 'none', or some of " + known + " with commas between them",
                      "'" + choices + "'");
  }
}

/// Reads words that are separated by commas, as `--start` on the command line does.
void read_start(ParameterReader& reader, scene::ReadOptions& options) {
  std::string choices;
  reader.read("start", choices);
  std::stringstream words(choices);
  for (std::string word; std::getline(words, word, ',');) {
    if (word == "clamp")
      options.clamp_start = true;
    else if (word == "equilibrium")
      options.equilibrium_start = true;
    else
      reader.complain("start", "must be 'clamp', 'equilibrium', both with a comma between them, or empty",
                      "'" + choices + "'");
  }
}

void read_web(ParameterReader& reader, Parameters& parameters) {
  reader.read("web", parameters.web);
  reader.read("web_address", parameters.web_address);
  reader.read("web_port", parameters.web_port, 0);
  reader.read("web_rate", parameters.web_rate);
  if (parameters.web_port > 65535) reader.complain("web_port", "must be <= 65535", std::to_string(parameters.web_port));
  if (!web::is_address(parameters.web_address))
    reader.complain("web_address", "must be an IP address, such as 127.0.0.1", "'" + parameters.web_address + "'");
}

scene::ReadResult read_file_or_text(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  std::string path;
  scene::ReadOptions options;
  ParameterReader reader(private_node);
  reader.read("scene", path);
  read_start(reader, options);
  options.lock_massless = read_choice(reader, "massless", "lock");
  reader.read("parameters", options.parameters);
  reader.read("xacro_args", options.xacro_arguments);
  reader.throw_if_any();
  // The working folder of a node is seldom known: with an absolute path, messages name the file clearly.
  if (!path.empty()) return scene::read_scene_file(std::filesystem::absolute(path), options);

  std::string key, text;
  if (!node.searchParam("robot_description", key) || !node.getParam(key, text)) {
    throw ParameterError("no scene: set the parameter 'robot_description' to the text of a URDF, or '" +
                         private_node.resolveName("scene") + "' to the path of one");
  }
  return scene::read_scene_text(text, key, options);
}

}  // namespace

Parameters read_parameters(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ParameterReader reader(private_node);
  reader.read("real_time_factor", parameters.real_time_factor, true);
  reader.read("max_catch_up", parameters.max_catch_up);
  reader.read("paused", parameters.paused);
  reader.read("publish_rate", parameters.publish_rate);
  reader.read("marker_rate", parameters.marker_rate);
  read_markers(reader, parameters.markers);
  reader.read("status_rate", parameters.status_rate);
  reader.read("interactive", parameters.interactive);
  reader.read("pull_stiffness", parameters.pull_stiffness, true);
  reader.read("pull_damping", parameters.pull_damping, true);
  reader.read("publish_clock", parameters.publish_clock);
  reader.read("clock_rate", parameters.clock_rate);
  reader.read("realtime", parameters.realtime);
  reader.read("lock_step", parameters.lock_step);
  reader.read("recovery_wall_time", parameters.recovery_wall_time, true);
  reader.read("command_timeout", parameters.command_timeout, true);
  reader.read("error_window", parameters.error_window, true);
  reader.read("stop_duration", parameters.stop_duration, true);
  read_frame_prefix(reader, parameters.frame_prefix);
  read_web(reader, parameters);
  reader.throw_if_any();
  return parameters;
}

void warn_of_unknown_parameters(const ros::NodeHandle& private_node, const std::vector<std::string>& more) {
  const std::string& place = private_node.getNamespace();
  XmlRpc::XmlRpcValue given;
  if (!ros::param::get(place, given) || given.getType() != XmlRpc::XmlRpcValue::TypeStruct) return;
  std::vector<std::string> known = kParameterNames;
  known.insert(known.end(), more.begin(), more.end());
  std::string unknown;
  for (const auto& [name, value] : given)
    if (std::find(known.begin(), known.end(), name) == known.end())
      unknown += fmt::format("\n{}/{}{}", place, name, suggestion(name, known));
  if (!unknown.empty()) ROS_WARN_STREAM("parameters that the node does not know, and that have no effect:" << unknown);
}

scene::SceneDescription read_scene(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  scene::ReadResult result = read_file_or_text(node, private_node);
  if (!result.scene) throw ParameterError("the scene cannot be used:\n" + scene::to_text(result.diagnostics));
  for (const scene::Diagnostic& warning : result.diagnostics) ROS_WARN_STREAM(warning.text());
  override_integrator(private_node, result.scene->integrator);
  return *std::move(result.scene);
}

}  // namespace flexarm::node
