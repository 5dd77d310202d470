#pragma once
/// Serves dynamic_reconfigure: parameters that may change while the simulation runs.

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>

#include <functional>
#include <string>
#include <vector>

#include "flexarm/scene/scene_description.h"
#include "parameters.h"

namespace flexarm::node {

class Node;

/// Provides ~set_parameters, ~parameter_descriptions and ~parameter_updates for clients of dynamic_reconfigure. The
/// parameters depend on the scene, since each servo has gains. A request is either carried out or, with a warning,
/// refused as a whole. The answer contains the values that are then in force.
class Reconfiguration {
 public:
  Reconfiguration(ros::NodeHandle& private_node, Node& simulator);
  Reconfiguration(const Reconfiguration&) = delete;
  Reconfiguration& operator=(const Reconfiguration&) = delete;

  /// Publishes descriptions and values of all parameters: at the start, and after the simulation has got another scene.
  void describe();
  std::string service() const { return server_.getService(); }

 private:
  struct Settings {
    scene::SceneDescription scene;
    Parameters parameters;
  };
  /// A parameter that is a number. All are numbers but "scheme".
  struct Number {
    enum class Owner {
      Node,        ///< a private parameter
      Integrator,  ///< a private parameter that overrides the scene's <integrator>
      Scene
    };
    std::string name, description;
    Owner owner;
    double least, most;
    std::function<double&(Settings&)> place;
  };
  /// The content of a request.
  struct Request {
    Settings settings;
    bool changes_scene = false;
    std::vector<const Number*> numbers;  ///< that the request names
  };

  static std::vector<Number> numbers_of(const scene::SceneDescription& scene);
  Settings settings() const;
  bool set(dynamic_reconfigure::Reconfigure::Request& request, dynamic_reconfigure::Reconfigure::Response& response);
  /// Reads a request. @returns why it is refused, or ""
  std::string read(const dynamic_reconfigure::Config& config, Request& wanted) const;
  std::string read_number(const std::string& name, double value, Request& wanted) const;
  std::string read_scheme(const dynamic_reconfigure::StrParameter& parameter, Request& wanted) const;
  /// Stores changed parameters of the node on the parameter server, so that they survive ~reload.
  void keep(Request& done, bool keeps_scheme) const;
  dynamic_reconfigure::Config config() const;
  dynamic_reconfigure::ConfigDescription description() const;

  ros::NodeHandle private_node_;
  Node& simulator_;
  std::vector<Number> numbers_;
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer server_;
};

}  // namespace flexarm::node
