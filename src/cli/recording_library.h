#pragma once
/// The library that reads and writes files of other programs (HDF5, ROS bags); loaded when it is first needed.

#include "recording/library.h"

namespace flexarm::cli {

/// @throws std::runtime_error with the reason if the library cannot be loaded
const recording::Library& recording_library();

}  // namespace flexarm::cli
