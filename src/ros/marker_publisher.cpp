#include "marker_publisher.h"

#include "advertise.h"

namespace flexarm::node {

MarkerPublisher::MarkerPublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                                 const std::string& root_frame)
    : schedule_(rate), messages_(simulation, root_frame) {
  publisher_ = advertise<visualization_msgs::MarkerArray>(node, "beam_markers", 2, run,
                                                          [this] { return messages_.make(stamp_); });
}

void MarkerPublisher::publish(const ros::Time& stamp, bool force) {
  if (!schedule_.due(stamp, force)) return;
  stamp_ = stamp;
  if (publisher_.getNumSubscribers() > 0) publisher_.publish(messages_.make(stamp));
}

}  // namespace flexarm::node
