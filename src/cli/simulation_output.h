#pragma once
/// The arguments of `flexarm simulate`, and its output.

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/scene_input.h"
#include "flexarm/simulation/result_writer.h"
#include "flexarm/simulation/run_summary.h"
#include "flexarm/simulation/simulation.h"
#include "pictures/vtk_writer.h"

namespace flexarm::cli {

/// The arguments of `flexarm simulate`.
struct SimulateArguments {
  SceneInput scene;
  std::string output, resume, checkpoint;
  std::string commands;  ///< file of efforts; empty: none
  std::string vtk;       ///< folder for ParaView
  /// Of the scene, for `vtk` and warnings: its meshes are read once, also if several runs are tried. Null without `vtk`
  /// and page.
  std::shared_ptr<const pictures::Picture> picture;
  double until = 10;                 ///< [s]
  double checkpoint_every = 0;       ///< [s]; 0: at the end only
  std::vector<std::string> columns;  ///< patterns of names; empty: all columns
  int every = 1;                     ///< steps between rows
  std::optional<double> accuracy;    ///< AccuracyRequest::accuracy; empty: the scene's, unless a step is given
  double interval = 0;           ///< between rows of a run with an accuracy [s]; 0: a hundredth of the simulated time
  bool estimates_error = false;  ///< whether rows have an error estimate; with an accuracy they always have one
  bool quiet = false;
  SimulationOptions options;
  double page_rate = 60;                 ///< instants in a page per second of simulated time
  std::optional<double> page_time;       ///< that the page shows first [s]; empty: that of the largest strain
  double vtk_rate = pictures::kVtkRate;  ///< the same for ParaView
};

/// Runs `flexarm simulate`. @returns the exit status
int simulate(SimulateArguments arguments);
/// Declares the options that say how a scene is simulated. `arguments` must outlive the command.
void add_time_and_accuracy(Command& command, SimulateArguments& arguments);
void add_commands(Command& command, SimulateArguments& arguments);

/// The outcome of a run.
struct Run {
  StepResult last;  ///< of the last step; converged unless the run failed
  RunSummary summary;
  double seconds = 0;       ///< wall time
  bool is_accurate = true;  ///< false if an accuracy was requested and not met
  std::string scheme = {};  ///< scheme of the run, if it is not the simulation's own
};

/// The stream for reports: standard error if results go to standard output, else standard output.
std::FILE* report_stream(const SimulateArguments& arguments);

bool has_output(const SimulateArguments& arguments);
bool is_bag(const std::string& path);
bool is_page(const std::string& path);
/// Says on standard error that a file's ending is not that of a kind of output, so that it gets CSV.
void warn_of_unknown_ending(const std::string& path);

/// Opens a writer of all outputs that writes rows in a thread of its own. For each row it also updates the summary,
/// which must outlive the writer. @returns null if there is no output
/// @throws InputError that names the error in the output or the columns
std::unique_ptr<ResultWriter> open_output(const SimulateArguments& arguments, const Simulation& simulation,
                                          RunSummary& summary);

}  // namespace flexarm::cli
