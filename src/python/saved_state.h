#pragma once
/// A state of a simulation as a value of Python's.

#include <memory>
#include <string>

#include "python/guarded_simulation.h"

namespace flexarm::python {

/// A snapshot beside the simulation that it is of; or, where it came from elsewhere, the text of a checkpoint.
class SavedState {
 public:
  explicit SavedState(const std::shared_ptr<GuardedSimulation>& origin)
      : snapshot_(origin->use().snapshot()), origin_(origin), family_(origin->family()) {}
  explicit SavedState(std::string text) : text_(std::move(text)) {}

  /// As write_checkpoint() writes it.
  /// @throws std::runtime_error if another thread works on the simulation that it is of, or its scene was edited since.
  std::string text() const;
  /// @throws std::invalid_argument if it is another scene's, scheme's or step's; nothing has changed then.
  void give_to(GuardedSimulation& simulation) const;

 private:
  Snapshot snapshot_;
  std::shared_ptr<GuardedSimulation> origin_;  // null: the text is all there is
  std::shared_ptr<const char> family_;         // of the origin then
  std::string text_;
};

}  // namespace flexarm::python
