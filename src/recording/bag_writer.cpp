#include "recording/bag_writer.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include <ros/message_traits.h>

#include "flexarm/scene/scene_description.h"
#include "flexarm/scene/sensor_topic.h"
#include "messages/sensor_messages.h"

namespace flexarm::recording {
namespace {

constexpr double kMarkerPeriod = 0.04;  // s

/// The stamp of the present state. Simulations start at 0, which is not a valid time in bags.
ros::Time stamp_of(const Simulation& simulation) {
  return std::max(ros::Time(simulation.time()), ros::TIME_MIN);
}

}  // namespace

template <class Write>
void BagWriter::checked(const Write& write) {
  try {
    write();
  } catch (const rosbag::BagException& error) {
    place_.fail(error.what());
  }
}

BagWriter::BagWriter(const std::string& path, const Simulation& simulation, const SceneOrigin& origin)
    : place_(path),
      states_(simulation, ""),
      markers_(simulation, simulation.scene().root_link, {},
               [](const std::string& warning) { std::fprintf(stderr, "%s\n", warning.c_str()); }),
      next_markers_(simulation.time()),
      sampled_(simulation.scene().sensors.size(), -1) {
  checked([&] {
    bag_.open(place_.unfinished(), rosbag::bagmode::Write);
    bag_.setCompression(rosbag::compression::LZ4);
    write_static_transforms(origin);
  });
}

/// The message is latched, so that players also give it to late subscribers.
void BagWriter::write_static_transforms(const SceneOrigin& origin) {
  namespace traits = ros::message_traits;
  const tf2_msgs::TFMessage message = states_.static_transforms(ros::TIME_MIN);
  const boost::shared_ptr<ros::M_string> header = boost::make_shared<ros::M_string>();
  *header = {{"topic", "/tf_static"},
             {"type", traits::datatype(message)},
             {"md5sum", traits::md5sum(message)},
             {"message_definition", traits::definition(message)},
             {"latching", "1"},
             {"scene", origin.path},
             {"scene_options", origin.options}};
  bag_.write("/tf_static", ros::TIME_MIN, message, header);
}

void BagWriter::write_row(const Simulation& simulation) {
  const ros::Time stamp = stamp_of(simulation);
  checked([&] {
    states_.update_joint_states(stamp);
    bag_.write("/joint_states", stamp, states_.joint_states());
    states_.update_transforms(stamp);
    bag_.write("/tf", stamp, states_.transforms());
    write_samples(simulation);
    if (simulation.time() < next_markers_) return;
    next_markers_ += kMarkerPeriod;
    bag_.write("/beam_markers", stamp, markers_.make(stamp, std::nullopt));
  });
}

void BagWriter::note_step(const Simulation& simulation, const StepResult&) {
  checked([&] { write_samples(simulation); });
}

void BagWriter::write_samples(const Simulation& simulation) {
  const ros::Time stamp = stamp_of(simulation);
  for (std::size_t i = 0; i < sampled_.size(); ++i) {
    const double sampled = simulation.sample(i).time;
    if (sampled == sampled_[i]) continue;
    sampled_[i] = sampled;
    const std::string topic = "/" + scene::sensor_topic(simulation.scene().sensors[i].name);
    std::visit([&](const auto& message) { bag_.write(topic, stamp, message); },
               messages::sensor_message(simulation, i, stamp, ""));
  }
}

void BagWriter::close() {
  checked([&] { bag_.close(); });
  place_.put_in_place();
}

}  // namespace flexarm::recording
