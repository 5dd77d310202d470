#pragma once
/// Joint efforts played against a simulation, as scripts/demo_commands.py does for the demo.

#include <functional>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::cli {

/// A constant effort on one joint.
struct EffortPulse {
  std::string joint;
  double begin, end;  ///< [s]
  double effort;      ///< [N or N m]
};

struct EffortSchedule {
  double period = 0;  ///< after which scripts/demo_commands.py starts it again [s]; 0: none
  std::vector<EffortPulse> pulses;
};

/// Reads a file like config/demo_commands.yaml: `period` and a list of `commands`
/// `{time: s, names: [joint, ...], efforts: [N m or N, ...], duration: s, repeat: times, every: s}`.
/// @throws std::runtime_error naming the file and the line that is not understood.
EffortSchedule read_effort_schedule(const std::string& path);

/// Commands the pulses of one simulation. A step's effort is the mean of the schedule over it, which has the schedule's
/// impulse whatever the step, and is the schedule itself where every pulse begins and ends with a step.
class EffortPlayer {
 public:
  /// @throws std::runtime_error for a joint that the simulation does not have or that cannot be commanded.
  EffortPlayer(const std::vector<EffortPulse>& pulses, const Simulation& simulation);

  /// Before each step.
  void command(Simulation& simulation) const;

 private:
  struct Track {
    std::size_t coordinate;
    std::vector<EffortPulse> pulses;
  };
  std::vector<Track> tracks_;
};

/// What commands the efforts of a file before each step, for any simulation of the scene; of no file: nothing.
/// @throws std::runtime_error as read_effort_schedule(); what is returned, as EffortPlayer.
std::function<std::function<void(Simulation&)>(const Simulation&)> effort_commands(const std::string& path);

}  // namespace flexarm::cli
