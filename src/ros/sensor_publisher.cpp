#include "sensor_publisher.h"

#include <variant>

#include "advertise.h"
#include "flexarm/scene/scene_description.h"
#include "messages/sensor_messages.h"

namespace flexarm::node {
SensorPublisher::SensorPublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run,
                                 const std::string& frame_prefix)
    : simulation_(simulation), frame_prefix_(frame_prefix), topics_(simulation.scene().sensors.size()) {
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const messages::SensorMessage type = messages::sensor_message(simulation, i, ros::Time(), frame_prefix_);
    std::visit(
        [&](const auto& message) {
          using Message = std::decay_t<decltype(message)>;
          topics_[i].publisher =
              advertise<Message>(node, messages::sensor_topic(simulation.scene().sensors[i].name), 100, run, [this, i] {
                return std::get<Message>(messages::sensor_message(simulation_, i, topics_[i].stamp, frame_prefix_));
              });
        },
        type);
  }
}

void SensorPublisher::publish(const ros::Time& stamp) {
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    Topic& topic = topics_[i];
    const double sampled = simulation_.sample(i).time;
    if (sampled == topic.sampled) continue;
    topic.sampled = sampled;
    topic.stamp = stamp;
    std::visit([&](const auto& message) { topic.publisher.publish(message); },
               messages::sensor_message(simulation_, i, stamp, frame_prefix_));
  }
}

}  // namespace flexarm::node
