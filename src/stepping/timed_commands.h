#pragma once
/// Numbers that topics command to joint coordinates for some time.

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::node {

enum class Commanded : std::size_t { Effort, SetPoint, Nothing };

/// What the thread that spins hands to the one that steps.
struct Command {
  static constexpr double kForEver = std::numeric_limits<double>::infinity();
  Commanded quantity = Commanded::Effort;
  std::size_t coordinate = 0;
  double value = 0;
  double lifetime = kForEver;  ///< simulated, from the beginning of the step in which it acts first [s]
  bool ends_message = true;    ///< commands of one message act from the same step on
};

/// Gives commands to a simulation. What expires becomes zero, in simulated time.
class TimedCommands {
 public:
  explicit TimedCommands(Simulation& simulation);

  void apply(const Command& command);
  /// Before each step. `time`: simulated time that no reset sets back [s].
  void expire(double time);
  /// Nothing expires any more; of another scene, too, that the simulation may be of by now.
  void forget();
  /// The simulation is of another scene now: of coordinates of the same name commands go on.
  void renumber(const std::vector<std::string>& names_before);
  /// The set point of a coordinate does not.
  void forget_set_point(std::size_t coordinate);

 private:
  void give(Commanded quantity, std::size_t coordinate, double value);

  Simulation& simulation_;
  double time_ = 0;                            ///< simulated, see expire()
  std::array<std::vector<double>, 2> expiry_;  ///< per quantity and coordinate, simulated time [s]; infinite: never
  double next_expiry_ = Command::kForEver;     ///< no later than the earliest of expiry_
};

}  // namespace flexarm::node
