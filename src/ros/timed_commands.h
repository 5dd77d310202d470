#pragma once
/// Numbers that topics command to joint coordinates for some time.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::node {

/// What is commanded, and how the simulation takes it.
struct CommandedQuantity {
  std::string name;                                    ///< for warnings: "effort"
  std::function<std::string(std::size_t)> find_fault;  ///< why a coordinate does not take it, or nothing
  std::function<void(std::size_t, double)> apply;      ///< to a coordinate
  std::function<bool(std::size_t)> expires;            ///< false: the last command holds
};

/// A command is taken whole or refused whole. What expires becomes zero, in simulated time.
class TimedCommands {
 public:
  /// @param timeout  a command expires after it, unless that names a duration [s]; 0: never
  TimedCommands(const Simulation& simulation, CommandedQuantity quantity, double timeout);

  /// What is wrong with a command, or nothing. @param duration  [s]
  std::string find_fault(const std::vector<std::string>& names, const std::vector<double>& values, double duration);
  /// Carries a command out, or says what is wrong with it. @param duration  [s]; 0: the timeout counts
  std::string command(const std::vector<std::string>& names, const std::vector<double>& values, double duration);
  /// Before each step. `time`: simulated time that no reset sets back [s].
  void expire(double time);
  /// Nothing expires any more.
  void forget();
  /// What was commanded to a coordinate does not expire any more.
  void forget(std::size_t coordinate);

 private:
  const Simulation& simulation_;
  CommandedQuantity quantity_;
  double timeout_;
  double time_ = 0;                     ///< simulated, see expire()
  std::vector<double> expiry_;          ///< per coordinate, simulated time [s]; infinite: never
  double next_expiry_;                  ///< smallest of expiry_
  std::vector<std::size_t> commanded_;  ///< scratch: coordinates of the command at hand
};

}  // namespace flexarm::node
