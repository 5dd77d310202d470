#pragma once
/// Commands for joint coordinates that expire after some time.

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "renumbering.h"

namespace flexarm::node {

enum class Commanded : std::size_t { Effort, SetPoint, Nothing };

/// A command for one coordinate, handed from the thread that spins ROS callbacks to the stepping thread.
struct Command {
  static constexpr double kForEver = std::numeric_limits<double>::infinity();
  Commanded quantity = Commanded::Effort;
  std::size_t coordinate = 0;
  double value = 0;
  double lifetime = kForEver;  ///< simulated time, from the beginning of the first step in which it acts [s]
  bool ends_message = true;    ///< last command of its message; all commands of a message act from the same step on
};

/// Gives commands to a simulation. A command that expires, in simulated time, is replaced by zero.
class TimedCommands {
 public:
  explicit TimedCommands(Simulation& simulation);

  void apply(const Command& command);
  /// To be called before each step. `time`: simulated time that resets do not set back [s].
  void expire(double time);
  /// From now on no command expires. The simulation may have become that of another scene.
  void forget();
  /// To be called when links of the simulation have come or gone.
  void renumber(const Renumbering& places);
  /// From now on the set point of this coordinate does not expire.
  void forget_set_point(std::size_t coordinate);

 private:
  void give(Commanded quantity, std::size_t coordinate, double value);

  Simulation& simulation_;
  double time_ = 0;                            ///< simulated time, see expire()
  std::array<std::vector<double>, 2> expiry_;  ///< per quantity and coordinate: simulated time [s]; infinite: never
  double next_expiry_ = Command::kForEver;     ///< lower bound of all times in expiry_
};

}  // namespace flexarm::node
