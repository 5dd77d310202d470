#pragma once
/// The columns of results.

#include <cstddef>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// One number of a row.
struct ResultColumn {
  std::string name, unit;
};

/// Selects which results of a simulation are put out, in SI units and world axes, quaternions as x y z w. By default
/// all of them, in this order:
///   time
///   joint/NAME/position|velocity|effort      for every released coordinate
///   frame/LINK/x|y|z|qx|qy|qz|qw             for every link
///   probe/NAME/x|y|z|qx|qy|qz|qw|vx|vy|vz    for every probe
///   probe/NAME/ax|ay|az                      the same, only where a pattern asks for it
///   sensor/NAME/...                          for every sensor what scene::sensor_channels() has: its last sample
///   KIND/NAME/...                            for every named element between points what it puts out:
///                                            spring/NAME/length
///   contact/FIRST/SECOND/fx|fy|fz|points|gap for every <contact> that names both: the force on the first, how many
///                                            points touch, the smallest gap
///   energy/kinetic|strain|potential|total|work|dissipated
///   momentum/x|y|z, angular_momentum/x|y|z   (about the world origin)
///   solver/step|iterations|halvings|deepest_halving|other_guesses|dissipated_steps
///                                            of a simulation in time: step size, and StepCounts since the row before
///   solver/error_estimate                    StepResult::error_estimate, where there is one
class ResultColumns {
 public:
  enum class Solver { Without, With, WithEstimate };

  /// The time, then the columns whose names match one of the `patterns`, which are wildcards as in a shell ("joint/*",
  /// "*/f[xyz]"); all columns if there are no patterns. They are in the order of the patterns, each once, at the first
  /// pattern that it matches; those of one pattern are in the order above. Only what a column needs is computed.
  /// @throws std::invalid_argument naming a pattern that no column matches.
  ResultColumns(const Simulation& simulation, Solver solver, const std::vector<std::string>& patterns = {});

  const std::vector<ResultColumn>& columns() const { return columns_; }
  /// Their present values, valid until the next call. `counts`: since the last row.
  const std::vector<double>& row(const Simulation& simulation, const StepCounts& counts);

 private:
  using Values = void (*)(const Simulation& simulation, const StepCounts& counts, std::size_t index,
                          std::vector<double>& values);
  /// One of a group's values, and the column that it fills.
  struct Taken {
    std::size_t value, column;
  };
  /// What is computed together.
  struct Group {
    Values values;
    std::size_t index;  // of the joint, link, probe or sensor
    std::vector<Taken> taken;
  };
  class Selection;

  std::vector<ResultColumn> columns_;
  std::vector<Group> groups_;
  std::vector<double> row_, values_;
};

}  // namespace flexarm
