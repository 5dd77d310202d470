#include "marker_publisher.h"

#include <ros/console.h>

#include "advertise.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm::node {

MarkerPublisher::MarkerPublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                                 const std::string& frame_prefix, const messages::MarkerChoice& choice)
    : simulation_(simulation), run_(run), frame_prefix_(frame_prefix), choice_(choice), schedule_(rate) {
  publisher_ =
      advertise<visualization_msgs::MarkerArray>(node, "beam_markers", 2, run, [this] { return make_message(); });
  adopt_scene();
}

void MarkerPublisher::adopt_scene() {
  messages_.emplace(simulation_, frame_prefix_ + simulation_.scene().root_link, choice_,
                    [](const std::string& warning) { ROS_WARN_STREAM(warning); });
  visualization_msgs::MarkerArray nothing;
  nothing.markers.emplace_back().action = visualization_msgs::Marker::DELETEALL;
  if (publisher_.getNumSubscribers() > 0) publisher_.publish(nothing);
}

void MarkerPublisher::publish(const ros::Time& stamp, bool force) {
  if (!schedule_.due(stamp, force)) return;
  stamp_ = stamp;
  if (publisher_.getNumSubscribers() > 0)
    publisher_.publish(make_message());
  else
    messages_->forget_trails();
}

visualization_msgs::MarkerArray MarkerPublisher::make_message() {
  const auto factor = real_time_factor_.measure(run_.simulated_time, RealTimeFactor::Clock::now(), run_.paused);
  const std::string state = run_.failed() ? "FAILED: " + run_.failure : run_.paused ? "PAUSED" : "";
  return messages_->make(stamp_, factor, state);
}

}  // namespace flexarm::node
