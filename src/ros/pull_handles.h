#pragma once
/// Handles in rviz with which the user pulls links.

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

/// Makes an interactive marker for each link that can move: at the link's first probe or, if it has none, at the tip of
/// a flexible link or at the centre of mass of a rigid link. While the user drags a marker, a spring and a damper pull
/// the point of the link towards the mouse.
class PullHandles {
 public:
  struct Spring {
    double stiffness, damping;  ///< [N/m], [N s/m]
  };
  using Apply = std::function<void(const std::vector<AppliedWrench>&)>;
  /// @param apply  gets all pulls that act from then on; they replace the earlier ones
  PullHandles(const ros::NodeHandle& private_node, const Simulation& shown, const std::string& root_frame,
              const Spring& spring, Apply apply);
  PullHandles(const PullHandles&) = delete;
  PullHandles& operator=(const PullHandles&) = delete;

  /// Moves handles that are not dragged to their points.
  void follow();
  /// To be called regularly: releases handles whose rviz has not sent anything for a while.
  void let_go_of_lost();
  /// Ends all pulls, even of handles that are still dragged.
  void forget();

 private:
  using Clock = std::chrono::steady_clock;
  using Feedback = visualization_msgs::InteractiveMarkerFeedback;
  struct Handle {
    std::size_t link;
    Vector3 at;                       ///< the point, in the undeformed link's frame [m]
    std::function<Vector3()> place;   ///< gives the present position of the point in the world [m]
    std::optional<Vector3> target;    ///< where the user drags it to, in the world [m]; empty: not dragged
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
