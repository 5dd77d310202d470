#include "marker_publisher.h"

#include "advertise.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm::node {

MarkerPublisher::MarkerPublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                                 const std::string& frame_prefix)
    : simulation_(simulation), frame_prefix_(frame_prefix), schedule_(rate) {
  publisher_ = advertise<visualization_msgs::MarkerArray>(node, "beam_markers", 2, run,
                                                          [this] { return messages_->make(stamp_); });
  adopt_scene();
}

void MarkerPublisher::adopt_scene() {
  messages_.emplace(simulation_, frame_prefix_ + simulation_.scene().root_link);
  visualization_msgs::MarkerArray nothing;
  nothing.markers.emplace_back().action = visualization_msgs::Marker::DELETEALL;
  if (publisher_.getNumSubscribers() > 0) publisher_.publish(nothing);
}

void MarkerPublisher::publish(const ros::Time& stamp, bool force) {
  if (!schedule_.due(stamp, force)) return;
  stamp_ = stamp;
  if (publisher_.getNumSubscribers() > 0) publisher_.publish(messages_->make(stamp));
}

}  // namespace flexarm::node
