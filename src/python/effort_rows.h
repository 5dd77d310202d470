#pragma once
/// Efforts for many steps, read directly from a numpy array.

#include <optional>
#include <vector>

#include "python/arrays.h"
#include "python/names.h"

namespace flexarm::python {

/// Efforts [N m or N] with the shape (steps, joints), or (joints,) for the same efforts in all steps. For a batch:
/// (simulations, steps, joints), (simulations, joints) or (joints,).
class EffortRows {
 public:
  /// @param efforts  must outlive this object; empty: nothing is commanded
  /// @param joints   the columns of `efforts`; empty: all joints that take commands
  /// @param batch    number of simulations, whose joints are the same; 0: no batch
  /// @throws std::invalid_argument that names what was expected, if the shape is wrong, a number is not finite or a
  /// joint takes no commands
  EffortRows(const Simulation& simulation, const std::optional<Array>& efforts,
             const std::optional<std::vector<Key>>& joints, long steps, std::size_t batch = 0);

  /// Commands the efforts of a step. May be called without Python's lock. `index`: of the simulation in its batch.
  void command(Simulation& simulation, long step, std::size_t index = 0) const {
    const double* row = efforts_ + static_cast<std::ptrdiff_t>(index) * batch_stride_ + step * stride_;
    for (const std::size_t joint : joints_) simulation.command_effort(joint, *row++);
  }

 private:
  std::vector<std::size_t> joints_;
  const double* efforts_ = nullptr;
  std::ptrdiff_t stride_ = 0;        // from one step to the next; 0: all have the same row
  std::ptrdiff_t batch_stride_ = 0;  // from one simulation to the next; 0: all have the same rows
};

}  // namespace flexarm::python
