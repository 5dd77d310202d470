#pragma once
/// Handles in rviz by which links are pulled.

#include <interactive_markers/interactive_marker_server.h>
#include <ros/node_handle.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::node {

/// One interactive marker on each link that moves: at the link's first probe or, where it has none, at the tip of a
/// flexible link and the centre of mass of a rigid one. As long as it is dragged, a spring and a damper pull that point
/// to the mouse.
class PullHandles {
 public:
  struct Spring {
    double stiffness, damping;  ///< [N/m], [N s/m]
  };
  using Apply = std::function<void(const std::vector<AppliedWrench>&)>;
  /// @param apply  takes all pulls that act from now on, in place of those of before
  PullHandles(const ros::NodeHandle& private_node, const Simulation& shown, const std::string& root_frame,
              const Spring& spring, Apply apply);
  PullHandles(const PullHandles&) = delete;
  PullHandles& operator=(const PullHandles&) = delete;

  /// Those that are not dragged go where their points are.
  void follow();
  /// Now and then: who drags and is not heard of any more has let go.
  void let_go_of_lost();
  /// What pulled does not any more, whoever still drags.
  void forget();

 private:
  using Clock = std::chrono::steady_clock;
  using Feedback = visualization_msgs::InteractiveMarkerFeedback;
  struct Handle {
    std::size_t link;
    Vector3 at;                       ///< in the undeformed link's frame [m]
    std::function<Vector3()> place;   ///< in the world [m]
    std::optional<Vector3> target;    ///< where it is dragged to, in the world [m]
    Clock::time_point last_feedback;  ///< while it is dragged
  };

  void add_handles();
  void show(const Handle& handle, double size);
  void receive(Handle& handle, const Feedback& feedback);
  void apply() const;

  const Simulation& shown_;
  std::string root_frame_;
  Spring spring_;
  Apply apply_;
  std::vector<Handle> handles_;
  interactive_markers::InteractiveMarkerServer server_;
};

}  // namespace flexarm::node
