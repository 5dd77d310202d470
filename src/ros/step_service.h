#pragma once
/// The service ~step.

#include <flexarm/Step.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>

#include "bell.h"

namespace flexarm::node {

class Node;

/// Makes the requested number of steps. As everything that changes the node, steps are made by the thread that runs
/// ros::spin(), but only a few at a time. In between this thread serves other callbacks, above all the emergency stop.
/// The caller waits in a thread of this service; further calls of ~step wait behind it.
class StepService {
 public:
  StepService(ros::NodeHandle& private_node, Node& simulator);
  ~StepService();
  StepService(const StepService&) = delete;
  StepService& operator=(const StepService&) = delete;

  const ros::ServiceServer& server() const { return server_; }

 private:
  // ---- called by the service's thread
  bool answer(Step::Request& request, Step::Response& response);

  // ---- called by the thread that runs ros::spin()
  void go_on();
  /// Why the call cannot be served, or "".
  std::string refusal() const;
  void end(const std::string& fault);

  Node& simulator_;
  std::mutex mutex_;
  std::condition_variable end_;
  Step::Response* response_ = nullptr;  ///< of the current call; null: no call
  std::uint32_t asked_ = 0, made_ = 0;
  std::uint64_t pauses_ = 0;  ///< Node::pauses() when the call began
  bool is_over_ = false;
  ros::CallbackQueue queue_;  ///< of calls
  Bell bell_;
  ros::ServiceServer server_;
  ros::AsyncSpinner spinner_;
};

}  // namespace flexarm::node
