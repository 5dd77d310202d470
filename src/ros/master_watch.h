#pragma once
/// A ROS master that goes away and comes back.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace flexarm::node {

/// Connections outlive the master, but one that comes back knows nobody. This looks after it now and then, in a thread
/// of its own, since an answer may take long, and registers the node's topics and services with it anew.
class MasterWatch {
 public:
  /// @param services  names of all that the node serves
  explicit MasterWatch(std::vector<std::string> services);
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

  /// Whether it has come back since the last call: parameters that were set are gone.
  bool has_come_back() { return has_come_back_.exchange(false); }

 private:
  void watch();
  void look();
  void register_anew() const;

  std::vector<std::string> services_;
  bool is_gone_ = false;
  std::atomic<bool> has_come_back_{false};
  std::mutex mutex_;
  std::condition_variable end_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace flexarm::node
