#pragma once
/// Files of other programs. The library that reads and writes them is loaded when it is needed first, since loading
/// HDF5 and rosbag takes longer than many simulations.

#include <memory>
#include <string>

#include "flexarm/simulation/linear_response.h"
#include "flexarm/simulation/result_writer.h"
#include "recording/replay.h"

namespace flexarm::recording {

/// What the library does. Makers of writers, and these, throw std::runtime_error naming the file if it cannot be
/// written.
struct Library {
  /// An HDF5 file, see Hdf5Writer.
  std::unique_ptr<ResultWriter> (*hdf5)(const std::string& path, const Simulation& simulation, ResultColumns columns);
  /// A ROS bag, see BagWriter.
  std::unique_ptr<ResultWriter> (*bag)(const std::string& path, const Simulation& simulation);
  /// A file of MATLAB, see write_mat().
  void (*mat)(const std::string& path, const std::string& scene, const LinearModel& model,
              const LinearResponses& responses);
  /// See recording::replay().
  ReplayReport (*replay)(Simulation simulation, const ReplayOptions& options);
};

constexpr const char* kLibrary = "libflexarm_recording.so";
/// The one symbol that is looked for there: a `const Library`.
constexpr const char* kSymbol = "flexarm_recording_library";

}  // namespace flexarm::recording
