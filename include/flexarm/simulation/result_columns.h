#pragma once
/// Selects the columns of result files, and computes their values.

#include <cstddef>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Name and unit of one number in a row of results.
struct ResultColumn {
  std::string name, unit;
};

/// Selects results of a simulation. They have SI units and world axes; quaternions are x y z w. By default all columns
/// are selected, in this order:
///   time
///   joint/NAME/position|velocity|effort      for every joint coordinate
///   frame/LINK/x|y|z|qx|qy|qz|qw             for every link
///   beam/LINK/K/...                          section_columns() of each node K = 0, 1, ... of a beam, only if a pattern
///                                            selects them
///   probe/NAME/x|y|z|qx|qy|qz|qw|vx|vy|vz    for every probe
///   probe/NAME/ax|ay|az                      the probe's acceleration, only if a pattern selects it
///   sensor/NAME/...                          for every sensor, its last sample: scene::sensor_channels()
///   KIND/NAME/...                            for every named force element, its results, such as spring/NAME/length
///   contact/FIRST/SECOND/fx|fy|fz|points|gap for every <contact> that names two bodies: the force on the first body,
///                                            the number of touching points, the smallest gap
///   energy/kinetic|strain|potential|total|work|dissipated
///   momentum/x|y|z, angular_momentum/x|y|z   (about the world origin)
///   solver/step|iterations|halvings|deepest_halving|other_guesses|dissipated_steps
///                                            only for simulations in time: step size, StepCounts since last row
///   solver/error_estimate                    StepResult::error_estimate, if the run estimates it
class ResultColumns {
 public:
  enum class Solver { Without, With, WithEstimate };

  /// Selects the time, then the columns whose names match one of the `patterns`; all columns if there are no patterns.
  /// Patterns are wildcards as in a shell ("joint/*", "*/f[xyz]"). Columns are in the order of the patterns; the
  /// columns of one pattern are in the order above. A column that matches several patterns appears once, at the first
  /// of them. Only the values that the columns need are computed.
  /// @throws std::invalid_argument naming a pattern that no column matches.
  ResultColumns(const Simulation& simulation, Solver solver, const std::vector<std::string>& patterns = {});

  const std::vector<ResultColumn>& columns() const { return columns_; }
  /// The present values of the columns, valid until the next call. `counts`: sums since the last row.
  const std::vector<double>& row(const Simulation& simulation, const StepCounts& counts);

 private:
  using Values = void (*)(const Simulation& simulation, const StepCounts& counts, std::size_t index,
                          std::vector<double>& values);
  /// One value of a group, and the column that it goes to.
  struct Taken {
    std::size_t value, column;
  };
  /// Values that are computed together.
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

/// The columns beam/LINK/K/* of a section of a beam: its pose in the world, x y z qx qy qz qw; its strains, axial ex,
/// shear ey ez, torsion kx, bending ky kz; its elastic stress resultants, forces fx fy fz and moments mx my mz. Strains
/// and resultants are in the section's axes.
const std::vector<ResultColumn>& section_columns();

}  // namespace flexarm
