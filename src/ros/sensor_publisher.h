#pragma once
/// Publishes the samples of the scene's sensors on sensors/NAME.

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstddef>
#include <map>
#include <string>

#include "flexarm/simulation/simulation.h"
#include "run_state.h"

namespace flexarm::node {

/// Each sensor has a topic of its own. Each sample is sent once, at the sensor's rate.
class SensorPublisher {
 public:
  SensorPublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run,
                  const std::string& frame_prefix);
  SensorPublisher(const SensorPublisher&) = delete;
  SensorPublisher& operator=(const SensorPublisher&) = delete;

  /// To be called after the simulation has got another scene. Topics of sensors that exist in both scenes stay.
  void adopt_scene();
  /// Sends the samples that were taken since the last call.
  void publish(const ros::Time& stamp);

 private:
  struct Topic {
    std::size_t sensor = 0, type = 0;  ///< index of the sensor; index of its message type
    ros::Publisher publisher;
    double sampled = -1;  ///< simulated time of the last sample that was sent [s]
    ros::Time stamp;      ///< of the last sample that was sent
  };

  const Simulation& simulation_;
  const RunState& run_;
  ros::NodeHandle node_;
  std::string frame_prefix_;
  std::map<std::string, Topic> topics_;  ///< by the sensor's name
};

}  // namespace flexarm::node
