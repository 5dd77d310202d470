#pragma once
/// Force elements evaluated outside a simulation.

#include <memory>

#include "model/force_element.h"

namespace flexarm::test {

/// Begins a step, and evaluates it. The element acts on all nodes that it reaches.
inline void evaluate_step(const ForceElement& element, ForceStep step, ForceAction& action) {
  const std::unique_ptr<ForceWorkspace> workspace = element.make_workspace();
  step.workspace = workspace.get();
  element.begin(step);
  element.evaluate(step, element.reach().data(), action);
}

}  // namespace flexarm::test
