#pragma once
/// Registers the node again when the ROS master was restarted.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace flexarm::node {

/// Connections between nodes outlive the master, but a restarted master does not know any node. This class asks the
/// master every second whether it knows this node; if not, it registers the node's topics and services again. It does
/// so in a thread of its own, since an answer may take long.
class MasterWatch {
 public:
  /// @param services  names of all services of the node
  explicit MasterWatch(std::vector<std::string> services);
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

  /// Whether the master was restarted since the last call, so that the parameters that the node had set are lost.
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
