#include "sensor_publisher.h"

#include <type_traits>
#include <utility>
#include <variant>

#include "advertise.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/scene/sensor_topic.h"
#include "messages/sensor_messages.h"

namespace flexarm::node {
SensorPublisher::SensorPublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run,
                                 const std::string& frame_prefix)
    : simulation_(simulation), run_(run), node_(node), frame_prefix_(frame_prefix) {
  adopt_scene();
}

void SensorPublisher::adopt_scene() {
  std::map<std::string, Topic> before = std::exchange(topics_, {});
  const auto& sensors = simulation_.scene().sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::string& name = sensors[i].name;
    const messages::SensorMessage type = messages::sensor_message(simulation_, i, ros::Time(), frame_prefix_);
    Topic& topic = topics_[name];
    topic.sensor = i;
    topic.type = type.index();
    // If the type changes, the old publisher must be destroyed before the topic can be advertised again.
    if (const auto old = before.find(name); old != before.end()) {
      if (old->second.type == topic.type) topic.publisher = old->second.publisher;
      before.erase(old);
      if (topic.publisher) continue;
    }
    std::visit(
        [&](const auto& message) {
          using Message = std::decay_t<decltype(message)>;
          topic.publisher = advertise<Message>(node_, scene::sensor_topic(name), 100, run_, [this, name] {
            const Topic& topic = topics_.at(name);
            return std::get<Message>(messages::sensor_message(simulation_, topic.sensor, topic.stamp, frame_prefix_));
          });
        },
        type);
  }
}

void SensorPublisher::publish(const ros::Time& stamp) {
  for (auto& [name, topic] : topics_) {
    const double sampled = simulation_.sample(topic.sensor).time;
    if (sampled == topic.sampled) continue;
    topic.sampled = sampled;
    topic.stamp = stamp;
    if (topic.publisher.getNumSubscribers() == 0) continue;
    std::visit([&topic = topic](const auto& message) { topic.publisher.publish(message); },
               messages::sensor_message(simulation_, topic.sensor, stamp, frame_prefix_));
  }
}

}  // namespace flexarm::node
