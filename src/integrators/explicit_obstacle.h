#pragma once
/// Which models explicit schemes can simulate. (docs/notes/explicit.md 3)

#include "model/model.h"

namespace flexarm {

/// Returns what explicit schemes cannot simulate in a model, in words; null: nothing.
const char* explicit_obstacle(const Model& model);
/// Whether a search for an accuracy may take explicit schemes: they can simulate the model, and no gear has play. They
/// do not find the times at which a gear closes, where forces may jump, so that estimates of their errors are wrong.
bool explicit_errors_are_known(const Model& model);

}  // namespace flexarm
