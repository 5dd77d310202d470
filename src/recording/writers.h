#pragma once
/// Results as files of other programs.

#include <memory>
#include <string>

#include "flexarm/simulation/result_writer.h"

namespace flexarm::recording {

/// An HDF5 file, see Hdf5Writer.
/// @throws std::runtime_error naming the file if it cannot be written; so do the writer's functions
std::unique_ptr<ResultWriter> make_hdf5_writer(const std::string& path, const Simulation& simulation,
                                               ResultColumns columns);
/// A ROS bag, see BagWriter.
/// @throws std::runtime_error as above
std::unique_ptr<ResultWriter> make_bag_writer(const std::string& path, const Simulation& simulation);

}  // namespace flexarm::recording
