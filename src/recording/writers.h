#pragma once
/// Results as files of other programs. What writes them is a library that is loaded when the first such file is asked
/// for: HDF5 and rosbag take longer to load than many a simulation takes.

#include <memory>
#include <string>

#include "flexarm/simulation/result_writer.h"

namespace flexarm::recording {

/// What the library makes. The functions, and those of the writers, throw std::runtime_error naming the file if it
/// cannot be written.
struct Writers {
  /// An HDF5 file, see Hdf5Writer.
  std::unique_ptr<ResultWriter> (*hdf5)(const std::string& path, const Simulation& simulation, ResultColumns columns);
  /// A ROS bag, see BagWriter.
  std::unique_ptr<ResultWriter> (*bag)(const std::string& path, const Simulation& simulation);
};

constexpr const char* kLibrary = "libflexarm_recording.so";
/// The one symbol that is looked for there: a `const Writers`.
constexpr const char* kWriters = "flexarm_recording_writers";

}  // namespace flexarm::recording
