#pragma once
/// Lets other threads request a callback in the thread that runs ros::spin(), without blocking.

#include <ros/callback_queue.h>

#include <atomic>
#include <functional>
#include <thread>

#include "stepping/semaphore.h"

namespace flexarm::node {

/// ring() never blocks. A thread of the bell puts the callback into ROS's callback queue, which uses locks.
class Bell {
 public:
  /// @param answer  called in the thread that runs ros::spin(), once for all rings since the last call
  explicit Bell(std::function<void()> answer);
  ~Bell();
  Bell(const Bell&) = delete;
  Bell& operator=(const Bell&) = delete;

  void ring();

 private:
  class Callback;

  void carry();

  std::function<void()> answer_;
  std::atomic<bool> is_rung_{false}, is_over_{false};
  Semaphore rung_;
  std::thread thread_;
};

}  // namespace flexarm::node
