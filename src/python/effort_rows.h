#pragma once
/// Efforts for many steps, read directly from a numpy array.

#include <optional>
#include <vector>

#include "python/arrays.h"
#include "python/names.h"

namespace flexarm::python {

/// Efforts [N m or N] with the shape (steps, joints), or (joints,) for the same efforts in all steps.
class EffortRows {
 public:
  /// @param efforts  must outlive this object; empty: nothing is commanded
  /// @param joints   the columns of `efforts`; empty: all joints that take commands
  /// @throws std::invalid_argument that names what was expected, if the shape is wrong, a number is not finite or a
  /// joint takes no commands
  EffortRows(const Simulation& simulation, const std::optional<Array>& efforts,
             const std::optional<std::vector<Key>>& joints, long steps);

  /// Commands the efforts of a step. May be called without Python's lock.
  void command(Simulation& simulation, long step) const {
    const double* row = efforts_ + step * stride_;
    for (const std::size_t joint : joints_) simulation.command_effort(joint, *row++);
  }

 private:
  std::vector<std::size_t> joints_;
  const double* efforts_ = nullptr;
  std::ptrdiff_t stride_ = 0;  // from one row to the next; 0: all steps have the same row
};

}  // namespace flexarm::python
