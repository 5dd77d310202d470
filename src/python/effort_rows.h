#pragma once
/// Efforts for many steps, read where Python has them.

#include <optional>
#include <vector>

#include "python/arrays.h"
#include "python/names.h"

namespace flexarm::python {

/// Efforts [N m or N], shape (steps, joints), or (joints,): the same for all steps.
class EffortRows {
 public:
  /// `efforts`: outlives this; none: nothing is commanded. `joints`: which ones; none: all that take commands.
  /// @throws std::invalid_argument naming what was expected if the shape is another one, a number is not finite or a
  /// joint takes no commands.
  EffortRows(const Simulation& simulation, const std::optional<Array>& efforts,
             const std::optional<std::vector<Key>>& joints, long steps);

  /// Needs no lock of Python's.
  void command(Simulation& simulation, long step) const {
    const double* row = efforts_ + step * stride_;
    for (const std::size_t joint : joints_) simulation.command_effort(joint, *row++);
  }

 private:
  std::vector<std::size_t> joints_;
  const double* efforts_ = nullptr;
  std::ptrdiff_t stride_ = 0;  // from row to row; 0: there is one
};

}  // namespace flexarm::python
