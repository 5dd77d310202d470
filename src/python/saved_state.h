#pragma once
/// A state of a simulation as a Python object.

#include <memory>
#include <string>

#include "python/guarded_simulation.h"

namespace flexarm::python {

/// A snapshot together with its simulation, or the text of a checkpoint that came from elsewhere.
class SavedState {
 public:
  explicit SavedState(const std::shared_ptr<GuardedSimulation>& origin)
      : snapshot_(origin->use().snapshot()), origin_(origin), family_(origin->family()) {}
  explicit SavedState(std::string text) : text_(std::move(text)) {}

  /// The text of the checkpoint, as write_checkpoint() writes it.
  /// @throws std::runtime_error if another thread works on the snapshot's simulation, or if its scene was edited since
  std::string text() const;
  /// Restores the state in a simulation.
  /// @throws std::invalid_argument if scene, scheme or step differ; then nothing has changed
  void give_to(GuardedSimulation& simulation) const;

 private:
  Snapshot snapshot_;
  std::shared_ptr<GuardedSimulation> origin_;  // null: there is only the text
  std::shared_ptr<const char> family_;         // of origin_ when the snapshot was taken
  std::string text_;
};

}  // namespace flexarm::python
