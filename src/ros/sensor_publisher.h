#pragma once
/// sensors/NAME: what the scene's sensors measure.

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstddef>
#include <map>
#include <string>

#include "flexarm/simulation/simulation.h"
#include "run_state.h"

namespace flexarm::node {

/// Each sensor has a topic of its own, on which each sample is sent once, at the sensor's rate.
class SensorPublisher {
 public:
  SensorPublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run,
                  const std::string& frame_prefix);
  SensorPublisher(const SensorPublisher&) = delete;
  SensorPublisher& operator=(const SensorPublisher&) = delete;

  /// The simulation is of another scene now. Topics that both have stay.
  void adopt_scene();
  /// Sends what was sampled since the last call.
  void publish(const ros::Time& stamp);

 private:
  struct Topic {
    std::size_t sensor = 0, type = 0;  ///< by index; of its messages
    ros::Publisher publisher;
    double sampled = -1;  ///< simulated time of the last sample that was sent [s]
    ros::Time stamp;      ///< of that
  };

  const Simulation& simulation_;
  const RunState& run_;
  ros::NodeHandle node_;
  std::string frame_prefix_;
  std::map<std::string, Topic> topics_;  ///< by the sensor's name
};

}  // namespace flexarm::node
