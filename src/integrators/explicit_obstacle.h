#pragma once
/// Which models explicit schemes can simulate. (docs/notes/explicit.md 3)

#include "model/model.h"

namespace flexarm {

/// Returns what explicit schemes cannot simulate in a model, in words; null: nothing.
const char* explicit_obstacle(const Model& model);
/// Whether a search for an accuracy may take explicit schemes: they can simulate the model, and no gear has play. A
/// gear that closes and opens within one step is not seen, so that estimates of coarse tries are wrong.
bool explicit_errors_are_known(const Model& model);

}  // namespace flexarm
