#pragma once
/// Writers of results that are loaded when they are asked for.

#include "recording/writers.h"

namespace flexarm::cli {

/// @throws std::runtime_error saying why, if their library cannot be loaded
const recording::Writers& recording_writers();

}  // namespace flexarm::cli
