#pragma once
/// The services ~attach, ~detach, ~spawn and ~delete.

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <vector>

namespace flexarm::node {

class Node;

/// Advertises these services, which add and remove links while the simulation moves.
std::vector<ros::ServiceServer> serve_payloads(ros::NodeHandle& private_node, Node& simulator);

}  // namespace flexarm::node
