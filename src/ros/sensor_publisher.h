#pragma once
/// sensors/NAME: what the scene's sensors measure.

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <string>
#include <vector>

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

  /// Sends what was sampled since the last call.
  void publish(const ros::Time& stamp);

 private:
  struct Topic {
    ros::Publisher publisher;
    double sampled = -1;  ///< simulated time of the last sample that was sent [s]
    ros::Time stamp;      ///< of that
  };

  const Simulation& simulation_;
  std::string frame_prefix_;
  std::vector<Topic> topics_;  ///< per sensor
};

}  // namespace flexarm::node
