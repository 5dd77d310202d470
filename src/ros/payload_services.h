#pragma once
/// ~attach, ~detach, ~spawn, ~delete.

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <vector>

namespace flexarm::node {

class Node;

/// Of services that change what is simulated while it moves.
std::vector<ros::ServiceServer> serve_payloads(ros::NodeHandle& private_node, Node& simulator);

}  // namespace flexarm::node
