#pragma once
/// Which models explicit schemes can simulate. (docs/notes/explicit.md 3)

#include "model/model.h"

namespace flexarm {

/// Returns what explicit schemes cannot simulate in a model, in words; null: nothing.
const char* explicit_obstacle(const Model& model);

}  // namespace flexarm
