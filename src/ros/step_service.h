#pragma once
/// ~step.

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

/// Makes the steps that are asked for, many at a call. They are made by the thread that spins, as all that concerns the
/// node, but a few at a time: in between it serves everybody else, the emergency stop above all. Who has called waits
/// in a thread of the service's own, and other callers of ~step behind him.
class StepService {
 public:
  StepService(ros::NodeHandle& private_node, Node& simulator);
  ~StepService();
  StepService(const StepService&) = delete;
  StepService& operator=(const StepService&) = delete;

  const ros::ServiceServer& server() const { return server_; }

 private:
  // ---- by the service's thread
  bool answer(Step::Request& request, Step::Response& response);

  // ---- by the thread that spins
  void go_on();
  /// Why the call cannot be served, or nothing.
  std::string refusal() const;
  void end(const std::string& fault);

  Node& simulator_;
  std::mutex mutex_;
  std::condition_variable end_;
  Step::Response* response_ = nullptr;  ///< of the call under way; null: there is none
  std::uint32_t asked_ = 0, made_ = 0;
  std::uint64_t pauses_ = 0;  ///< of the node, as the call began
  bool is_over_ = false;
  ros::CallbackQueue queue_;  ///< of calls
  Bell bell_;
  ros::ServiceServer server_;
  ros::AsyncSpinner spinner_;
};

}  // namespace flexarm::node
