#include "reconfiguration.h"

#include <ros/console.h>
#include <ros/master.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "flexarm/schemes/integrator_description.h"
#include "node.h"

namespace flexarm::node {
namespace {

using dynamic_reconfigure::Config;
using scene::ServoDescription;

constexpr const char* kScheme = "scheme";
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSmallest = std::numeric_limits<double>::min();  ///< lower bound of parameters that must be > 0

template <class Parameter, class Value>
Parameter named(const std::string& name, const Value& value) {
  Parameter parameter;
  parameter.name = name;
  parameter.value = value;
  return parameter;
}

/// The enumeration of schemes in the format of dynamic_reconfigure's generators: a Python literal.
std::string choice_of_schemes() {
  std::string choices;
  for (const std::string_view scheme : scheme_names())
    choices += fmt::format(
        "{{'name': '{0}', 'type': 'str', 'value': '{0}', 'description': '', 'srcline': 0, 'srcfile': '', 'cconsttype': "
        "'const char * const', 'ctype': 'std::string'}}, ",
        scheme);
  return "{'enum': [" + choices + "], 'enum_description': 'time integration schemes'}";
}

dynamic_reconfigure::ParamDescription described(const std::string& name, const std::string& type,
                                                const std::string& description, const std::string& choices = "") {
  dynamic_reconfigure::ParamDescription parameter;
  parameter.name = name;
  parameter.type = type;
  parameter.description = description;
  parameter.edit_method = choices;
  return parameter;
}

std::string range(double least, double most) {
  const std::string lower = least == kSmallest ? "> 0" : fmt::format(">= {}", least);
  if (most < kInfinity) return fmt::format("{} and <= {}", lower, most);
  return std::isinf(least) ? "finite" : "finite and " + lower;
}

}  // namespace

Reconfiguration::Reconfiguration(ros::NodeHandle& private_node, Node& simulator)
    : private_node_(private_node),
      simulator_(simulator),
      descriptions_(
          private_node.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, /*latch=*/true)),
      updates_(private_node.advertise<Config>("parameter_updates", 1, /*latch=*/true)),
      server_(private_node.advertiseService("set_parameters", &Reconfiguration::set, this)) {
  describe();
}

std::vector<Reconfiguration::Number> Reconfiguration::numbers_of(const scene::SceneDescription& scene) {
  using Owner = Number::Owner;
  std::vector<Number> numbers = {
      {"step", "time step [s]", Owner::Integrator, kSmallest, kLongestStep,
       [](Settings& s) -> double& { return s.scene.integrator.step; }},
      {"tolerance", "tolerance of Newton's method, relative", Owner::Integrator, kSmallest, kLargestTolerance,
       [](Settings& s) -> double& { return s.scene.integrator.tolerance; }},
      {"real_time_factor", "simulated time per wall time; 0: as fast as possible", Owner::Node, 0, kInfinity,
       [](Settings& s) -> double& { return s.parameters.real_time_factor; }},
      {"publish_rate", "rate of joint_states, /tf and beam_states [Hz]", Owner::Node, kSmallest, kInfinity,
       [](Settings& s) -> double& { return s.parameters.publish_rate; }},
      {"marker_rate", "rate of beam_markers [Hz]", Owner::Node, kSmallest, kInfinity,
       [](Settings& s) -> double& { return s.parameters.marker_rate; }},
      {"status_rate", "rate of ~status [Hz]", Owner::Node, kSmallest, kInfinity,
       [](Settings& s) -> double& { return s.parameters.status_rate; }},
  };
  for (int axis = 0; axis < 3; ++axis)
    numbers.push_back({std::string("gravity_") + "xyz"[axis], "gravity in the world's axes [m/s^2]", Owner::Scene,
                       -kInfinity, kInfinity, [axis](Settings& s) -> double& { return s.scene.gravity[axis]; }});
  const auto add_gain = [&](const std::string& name, auto place) {
    numbers.push_back({name, "gain of a servo", Owner::Scene, 0, kInfinity, place});
  };
  // Only the gains that the mode has (docs/scene/drives.md).
  const auto add_gains = [&](const std::string& prefix, ServoMode mode, const auto& gains) {
    if (mode == ServoMode::Effort) return;
    add_gain(prefix + "/kp", [gains](Settings& s) -> double& { return gains(s).kp; });
    add_gain(prefix + "/ki", [gains](Settings& s) -> double& { return gains(s).ki; });
    if (mode == ServoMode::Position) add_gain(prefix + "/kd", [gains](Settings& s) -> double& { return gains(s).kd; });
  };
  for (std::size_t i = 0; i < scene.servos.size(); ++i) {
    const ServoDescription& servo = scene.servos[i];
    add_gains(servo.coordinate, servo.mode, [i](Settings& s) -> ServoDescription& { return s.scene.servos[i]; });
    for (std::size_t k = 0; k < servo.other_modes.size(); ++k) {
      const ServoMode mode = servo.other_modes[k].mode;
      add_gains(servo.coordinate + (mode == ServoMode::Velocity ? "/velocity" : "/position"), mode,
                [i, k](Settings& s) -> ServoDescription::Gains& { return s.scene.servos[i].other_modes[k]; });
    }
  }
  return numbers;
}

Reconfiguration::Settings Reconfiguration::settings() const {
  return {simulator_.simulation().scene(), simulator_.parameters()};
}

void Reconfiguration::describe() {
  numbers_ = numbers_of(simulator_.simulation().scene());
  descriptions_.publish(description());
  updates_.publish(config());
}

Config Reconfiguration::config() const {
  Settings in_force = settings();
  Config config;
  config.strs.push_back(named<dynamic_reconfigure::StrParameter>(kScheme, in_force.scene.integrator.scheme));
  for (const Number& number : numbers_)
    config.doubles.push_back(named<dynamic_reconfigure::DoubleParameter>(number.name, number.place(in_force)));
  dynamic_reconfigure::GroupState& group = config.groups.emplace_back();
  group.name = "Default";
  group.state = true;
  return config;
}

dynamic_reconfigure::ConfigDescription Reconfiguration::description() const {
  dynamic_reconfigure::ConfigDescription description;
  description.dflt = description.min = description.max = config();
  description.min.strs[0].value = description.max.strs[0].value = "";
  dynamic_reconfigure::Group& group = description.groups.emplace_back();
  group.name = "Default";
  group.parameters.push_back(described(kScheme, "str", "scheme of the time integration", choice_of_schemes()));
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    const Number& number = numbers_[i];
    group.parameters.push_back(described(number.name, "double", number.description));
    description.min.doubles[i].value = number.least;
    description.max.doubles[i].value = number.most;
  }
  return description;
}

bool Reconfiguration::set(dynamic_reconfigure::Reconfigure::Request& request,
                          dynamic_reconfigure::Reconfigure::Response& response) {
  Request wanted;
  wanted.settings = settings();
  std::string fault = read(request.config, wanted);
  try {
    std::optional<scene::SceneDescription> scene;
    if (wanted.changes_scene) scene = wanted.settings.scene;
    if (fault.empty()) simulator_.change(std::move(scene), wanted.settings.parameters);
  } catch (const std::exception& error) {
    fault = error.what();
  }
  if (fault.empty())
    keep(wanted, !request.config.strs.empty());
  else
    ROS_WARN_STREAM(server_.getService() << " refused, nothing was changed: " << fault);
  response.config = config();
  updates_.publish(response.config);
  return true;
}

std::string Reconfiguration::read(const Config& config, Request& wanted) const {
  const auto read_all = [](const auto& parameters, const auto& read_one) {
    std::string fault;
    for (const auto& parameter : parameters)
      if (fault.empty()) fault = read_one(parameter);
    return fault;
  };
  const auto number = [&](const auto& parameter) {
    return read_number(parameter.name, static_cast<double>(parameter.value), wanted);
  };
  std::string fault = read_all(config.strs, [&](const auto& parameter) { return read_scheme(parameter, wanted); });
  if (fault.empty()) fault = read_all(config.doubles, number);
  if (fault.empty()) fault = read_all(config.ints, number);  // clients may write 1 for 1.0
  if (fault.empty())
    fault = read_all(config.bools,
                     [](const auto& parameter) { return "'" + parameter.name + "' is not a boolean parameter"; });
  return fault;
}

std::string Reconfiguration::read_number(const std::string& name, double value, Request& wanted) const {
  const auto number =
      std::find_if(numbers_.begin(), numbers_.end(), [&](const Number& one) { return one.name == name; });
  if (number == numbers_.end()) return "there is no numeric parameter '" + name + "'";
  if (!std::isfinite(value) || value < number->least || value > number->most)
    return fmt::format("'{}' must be {}, got {}", name, range(number->least, number->most), value);
  double& place = number->place(wanted.settings);
  if (place != value && number->owner != Number::Owner::Node) wanted.changes_scene = true;
  place = value;
  wanted.numbers.push_back(&*number);
  return {};
}

std::string Reconfiguration::read_scheme(const dynamic_reconfigure::StrParameter& parameter, Request& wanted) const {
  if (parameter.name != kScheme) return "there is no text parameter '" + parameter.name + "'";
  IntegratorDescription& integrator = wanted.settings.scene.integrator;
  if (parameter.value == integrator.scheme) return {};
  const std::vector<std::string_view>& known = scheme_names();
  if (std::find(known.begin(), known.end(), parameter.value) == known.end())
    return fmt::format("'scheme' must be one of {}, got '{}'", fmt::join(known, ", "), parameter.value);
  integrator = with_scheme(integrator, parameter.value);
  wanted.changes_scene = true;
  return {};
}

void Reconfiguration::keep(Request& done, bool keeps_scheme) const {
  if (!ros::master::check()) return;  // setParam() would wait for a master that is gone
  if (keeps_scheme) private_node_.setParam(kScheme, done.settings.scene.integrator.scheme);
  for (const Number* number : done.numbers)
    if (number->owner != Number::Owner::Scene) private_node_.setParam(number->name, number->place(done.settings));
}

}  // namespace flexarm::node
