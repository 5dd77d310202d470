#include "beam_state_publisher.h"

#include "advertise.h"
#include "flexarm/scene/scene_description.h"
#include "messages/conversions.h"

namespace flexarm::node {

BeamStatePublisher::BeamStatePublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run,
                                       double rate, const std::string& frame_prefix)
    : simulation_(simulation), schedule_(rate), frame_prefix_(frame_prefix) {
  publisher_ = advertise<BeamStateArray>(node, "beam_states", 10, run, [this] { return make_message(stamp_); });
}

void BeamStatePublisher::publish(const ros::Time& stamp, bool force) {
  if (!schedule_.due(stamp, force)) return;
  stamp_ = stamp;
  publish_to_listeners(publisher_, [this] { return make_message(stamp_); });
}

BeamStateArray BeamStatePublisher::make_message(const ros::Time& stamp) {
  BeamStateArray message;
  message.header.stamp = stamp;
  message.header.frame_id = frame_prefix_ + simulation_.scene().root_link;
  for (std::size_t link = 0; link < simulation_.link_names().size(); ++link) {
    if (!simulation_.is_flexible(link)) continue;
    points_.clear();
    simulation_.beam_points(link, 0, points_);
    BeamState& beam = message.beams.emplace_back();
    beam.link = simulation_.link_names()[link];
    for (const BeamPoint& point : points_) {
      geometry_msgs::Wrench resultant;
      resultant.force = messages::to_vector3(point.resultant.head<3>());
      resultant.torque = messages::to_vector3(point.resultant.tail<3>());
      beam.arc_length.push_back(point.arc_length);
      beam.pose.push_back(messages::to_pose(point.pose));
      beam.strain.push_back(messages::to_vector3(point.strain.head<3>()));
      beam.curvature.push_back(messages::to_vector3(point.strain.tail<3>()));
      beam.resultant.push_back(resultant);
    }
  }
  return message;
}

}  // namespace flexarm::node
