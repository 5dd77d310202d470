#pragma once
/// What writes and reads files of other programs; loaded when it is asked for.

#include "recording/library.h"

namespace flexarm::cli {

/// @throws std::runtime_error saying why, if their library cannot be loaded
const recording::Library& recording_library();

}  // namespace flexarm::cli
