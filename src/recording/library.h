#pragma once
/// The interface of the library that reads and writes files of other programs. The library is loaded only when needed,
/// because loading HDF5 and rosbag takes longer than many simulations.

#include <memory>
#include <string>

#include "flexarm/simulation/linear_response.h"
#include "flexarm/simulation/result_writer.h"
#include "recording/replay.h"
#include "recording/scene_origin.h"

namespace flexarm::recording {

/// The functions of the library. Except for replay, the functions and the writers that they make throw
/// std::runtime_error naming the file if it cannot be written.
struct Library {
  /// Makes a writer of HDF5 files, see Hdf5Writer.
  std::unique_ptr<ResultWriter> (*hdf5)(const std::string& path, const Simulation& simulation, ResultColumns columns,
                                        const SceneOrigin& origin);
  /// Makes a writer of ROS bags, see BagWriter.
  std::unique_ptr<ResultWriter> (*bag)(const std::string& path, const Simulation& simulation,
                                       const SceneOrigin& origin);
  /// Writes a MATLAB file, see write_mat().
  void (*mat)(const std::string& path, const std::string& scene, const LinearModel& model,
              const LinearResponses& responses);
  /// See recording::replay().
  ReplayReport (*replay)(Simulation simulation, const ReplayOptions& options);
};

constexpr const char* kLibrary = "libflexarm_recording.so";
/// The only symbol of the library that is used: a `const Library`.
constexpr const char* kSymbol = "flexarm_recording_library";

}  // namespace flexarm::recording
