#include "payload_services.h"

#include <flexarm/AttachLink.h>
#include <flexarm/DeleteLink.h>
#include <flexarm/DetachLink.h>
#include <flexarm/SpawnModel.h>
#include <ros/console.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "flexarm/scene/resource_path.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/payloads.h"
#include "messages/conversions.h"
#include "node.h"

namespace flexarm::node {
namespace {

Spawn place_of(const SpawnModel::Request& request) {
  const geometry_msgs::Quaternion& q = request.pose.orientation;
  Spawn out;
  out.pose.position = messages::to_vector(request.pose.position);
  // All zeros: the message gives no orientation.
  if (q.w != 0 || q.x != 0 || q.y != 0 || q.z != 0) out.pose.orientation = Quaternion(q.w, q.x, q.y, q.z);
  out.linear = messages::to_vector(request.twist.linear);
  out.angular = messages::to_vector(request.twist.angular);
  out.prefix = request.prefix;
  return out;
}

/// The path of a model's file, which may be relative to the folder of the scene's file.
/// @throws std::runtime_error if the scene has no file, or there is no such package
std::string path_of(const std::string& file, const std::string& scene_file) {
  const bool is_relative = file.find("://") == std::string::npos && std::filesystem::path(file).is_relative();
  if (is_relative && !std::filesystem::is_regular_file(scene_file))
    throw std::runtime_error("'" + file + "' is a path relative to the folder of the scene's file, but the scene is " +
                             "the text of '" + scene_file + "': give an absolute path, or package://PACKAGE/PATH");
  return scene::path_of_resource(file, scene_file);
}

/// @throws std::invalid_argument that lists all errors of the model
scene::SceneDescription model_of(const SpawnModel::Request& request, const std::string& scene_file) {
  if (request.model_xml.empty() == request.file.empty())
    throw std::invalid_argument("a model is given by model_xml or by file, not by both or none");
  scene::ReadOptions options;
  options.is_spawned = true;
  scene::ReadResult read = request.file.empty() ? scene::read_scene_text(request.model_xml, "model_xml", options)
                                                : scene::read_scene_file(path_of(request.file, scene_file), options);
  if (!read.scene) throw std::invalid_argument("the model cannot be used:\n" + scene::to_text(read.diagnostics));
  for (const scene::Diagnostic& warning : read.diagnostics) ROS_WARN_STREAM(warning.text());
  return *std::move(read.scene);
}

/// Advertises a service that calls `act(simulation, request)`; its exceptions become the answer's message.
template <class Service, class Act>
ros::ServiceServer serve(ros::NodeHandle& private_node, const std::string& name, Node& simulator, const Act& act) {
  const boost::function<bool(typename Service::Request&, typename Service::Response&)> callback =
      [&simulator, act](typename Service::Request& request, typename Service::Response& response) {
        try {
          simulator.edit([&](Simulation& simulation) { act(simulation, request); });
          response.success = true;
        } catch (const std::exception& error) {
          response.message = error.what();
        }
        return true;
      };
  return private_node.advertiseService(name, callback);
}

}  // namespace

std::vector<ros::ServiceServer> serve_payloads(ros::NodeHandle& private_node, Node& simulator) {
  return {
      serve<AttachLink>(private_node, "attach", simulator,
                        [](Simulation& simulation, const AttachLink::Request& request) {
                          attach(simulation, request.link, request.to);
                        }),
      serve<DetachLink>(
          private_node, "detach", simulator,
          [](Simulation& simulation, const DetachLink::Request& request) { detach(simulation, request.link); }),
      serve<SpawnModel>(private_node, "spawn", simulator,
                        [](Simulation& simulation, const SpawnModel::Request& request) {
                          spawn(simulation, model_of(request, simulation.scene().file), place_of(request));
                        }),
      serve<DeleteLink>(
          private_node, "delete", simulator,
          [](Simulation& simulation, const DeleteLink::Request& request) { remove(simulation, request.link); }),
  };
}

}  // namespace flexarm::node
