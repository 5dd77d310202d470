#pragma once
/// Calls the thread that spins.

#include <ros/callback_queue.h>

#include <atomic>
#include <functional>
#include <thread>

#include "stepping/semaphore.h"

namespace flexarm::node {

/// Whoever rings does not wait: a thread of the bell's own puts the callback into ROS's queue, which has locks.
class Bell {
 public:
  /// @param answer  is called by the thread that spins, once for all rings since the last call
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
