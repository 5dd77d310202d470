#pragma once
/// What may be changed while the simulation runs, for dynamic_reconfigure.

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

/// ~set_parameters, ~parameter_descriptions and ~parameter_updates, as clients of dynamic_reconfigure expect them. What
/// parameters there are depends on the scene: each servo has gains. A request is carried out whole, or refused whole
/// with a warning; the answer says what is in force.
class Reconfiguration {
 public:
  Reconfiguration(ros::NodeHandle& private_node, Node& simulator);
  Reconfiguration(const Reconfiguration&) = delete;
  Reconfiguration& operator=(const Reconfiguration&) = delete;

  /// Tells what there is, and what is in force: at the start, and where the simulation is of another scene.
  void describe();
  std::string service() const { return server_.getService(); }

 private:
  struct Settings {
    scene::SceneDescription scene;
    Parameters parameters;
  };
  /// A parameter that is a number. There is one that is not, "scheme".
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
  /// What somebody asks for.
  struct Request {
    Settings settings;
    bool changes_scene = false;
    std::vector<const Number*> numbers;  ///< that are named
  };

  static std::vector<Number> numbers_of(const scene::SceneDescription& scene);
  Settings settings() const;
  bool set(dynamic_reconfigure::Reconfigure::Request& request, dynamic_reconfigure::Reconfigure::Response& response);
  /// Reads what is wanted. @returns why it cannot be had, or nothing
  std::string read(const dynamic_reconfigure::Config& config, Request& wanted) const;
  std::string read_number(const std::string& name, double value, Request& wanted) const;
  std::string read_scheme(const dynamic_reconfigure::StrParameter& parameter, Request& wanted) const;
  /// Parameters of the node that were changed stay so where the scene is read again.
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
