#pragma once
/// Writes a simulation as a ROS bag.

#include <string>
#include <vector>

#include <rosbag/bag.h>

#include "flexarm/simulation/result_writer.h"
#include "messages/marker_messages.h"
#include "messages/state_messages.h"
#include "recording/replaced_file.h"
#include "recording/scene_origin.h"

namespace flexarm::recording {

/// Writes the messages that the node would publish, stamped with simulated time: /joint_states and /tf with each row,
/// /beam_markers 25 times per second, /sensors/NAME with each sample, /tf_static once. The fields `scene` and
/// `scene_options` of the connection of /tf_static name the scene (SceneOrigin). An older file at the same path stays
/// until close().
class BagWriter : public ResultWriter {
 public:
  /// @throws std::runtime_error naming the file if it cannot be written. The other functions do the same.
  BagWriter(const std::string& path, const Simulation& simulation, const SceneOrigin& origin);

  void write_row(const Simulation& simulation) override;
  void note_step(const Simulation& simulation, const StepResult& result) override;
  bool looks_at_steps() const override { return !sampled_.empty(); }
  void close() override;

 private:
  /// Calls `write`. Adds the name of the file to its errors.
  template <class Write>
  void checked(const Write& write);
  void write_samples(const Simulation& simulation);
  void write_static_transforms(const SceneOrigin& origin);

  ReplacedFile place_;
  rosbag::Bag bag_;
  messages::StateMessages states_;
  messages::MarkerMessages markers_;
  double next_markers_ = 0;      // [s]
  std::vector<double> sampled_;  // per sensor: time of the last sample that was written [s]
};

}  // namespace flexarm::recording
