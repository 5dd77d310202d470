#pragma once
/// Writes a run as files for ParaView.

#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "flexarm/simulation/result_writer.h"
#include "pictures/due_times.h"
#include "pictures/vtk_file.h"
#include "pictures/vtk_parts.h"

namespace flexarm::pictures {

/// Instants per second of simulated time in files for ParaView, if the user does not choose.
constexpr double kVtkRate = 30;

/// Writes a folder: `run.pvd`, which lists all that follows by time; for each of vtk_parts() a list `PART.pvd` of its
/// own, and a folder PART with a file for each instant. At any time the lists are files as a whole, and at most about a
/// second behind. Files that an earlier run left there under these names are removed.
class VtkWriter : public ResultWriter {
 public:
  /// @param simulation  must outlive the writer, and be in the state of the last row when it is closed
  /// @param picture     of the simulation; need not outlive the writer
  /// @throws std::runtime_error naming the file that cannot be written. The other functions do the same.
  VtkWriter(const std::string& folder, const Simulation& simulation, const Picture& picture, double rate);

  /// Completes the lists if a run has failed.
  ~VtkWriter() override;

  void write_row(const Simulation& simulation) override;
  void close() override;

 private:
  struct Series {
    std::unique_ptr<VtkPart> part;
    VtkCollection list;
  };

  void write_instant(const Simulation& simulation);
  void write_lists();

  std::filesystem::path folder_;
  const Simulation& simulation_;
  DueTimes due_;
  std::vector<Series> series_;
  VtkCollection run_;
  std::chrono::steady_clock::time_point listed_;                 // when the lists were written
  bool are_listed_ = true;                                       // whether they have all instants
  std::size_t count_ = 0;                                        // instants
  double last_time_ = std::numeric_limits<double>::quiet_NaN();  // of the last instant
};

}  // namespace flexarm::pictures
