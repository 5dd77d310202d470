#pragma once
/// Plays joint efforts of a file in a simulation, as scripts/demo_commands.py does in the demo.

#include <functional>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::cli {

/// A constant effort on one joint for some time.
struct EffortPulse {
  std::string joint;
  double begin, end;  ///< [s]
  double effort;      ///< [N or N m]
};

struct EffortSchedule {
  double period = 0;  ///< the schedule repeats with this period in scripts/demo_commands.py [s]; 0: no repetition
  std::vector<EffortPulse> pulses;
};

/// Reads a file like config/demo_commands.yaml: `period` and a list of `commands`
/// `{time: s, names: [joint, ...], efforts: [N m or N, ...], duration: s, repeat: times, every: s}`.
/// @throws std::runtime_error that names the file and the line that cannot be read
EffortSchedule read_effort_schedule(const std::string& path);

/// Commands the pulses in a simulation. In each step, the effort is the mean of the schedule over the step, so the
/// impulse is exact for any step. If all pulses begin and end with steps, the efforts are exactly those of the
/// schedule.
class EffortPlayer {
 public:
  /// @throws std::runtime_error if a joint does not exist in the simulation or cannot be commanded.
  EffortPlayer(const std::vector<EffortPulse>& pulses, const Simulation& simulation);

  /// To be called before each step.
  void command(Simulation& simulation) const;

 private:
  struct Track {
    std::size_t coordinate;
    std::vector<EffortPulse> pulses;
  };
  std::vector<Track> tracks_;
};

/// Makes players of a file for any simulation of the scene, to be called before each step. An empty path: no efforts.
/// @throws std::runtime_error as read_effort_schedule(); the returned function as EffortPlayer's constructor
std::function<std::function<void(Simulation&)>(const Simulation&)> effort_commands(const std::string& path);

}  // namespace flexarm::cli
