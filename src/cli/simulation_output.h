#pragma once
/// What `flexarm simulate` is asked for, and what it puts out.

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/scene_input.h"
#include "flexarm/simulation/result_writer.h"
#include "flexarm/simulation/run_summary.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::cli {

/// What `flexarm simulate` is asked for.
struct SimulateArguments {
  SceneInput scene;
  std::string output, resume, checkpoint;
  double until = 10;                 ///< [s]
  double checkpoint_every = 0;       ///< [s]; 0: at the end only
  std::vector<std::string> columns;  ///< patterns; empty: all
  int every = 1;                     ///< steps between rows
  std::optional<double> accuracy;    ///< AccuracyRequest::accuracy; none: that of the scene, unless a step is given
  double interval = 0;               ///< between rows where there is an accuracy [s]; 0: a hundredth of the time
  bool estimates_error = false;      ///< so that rows have it; always where there is an accuracy
  bool quiet = false;
  SimulationOptions options;
};

/// How a run went.
struct Run {
  StepResult last;  ///< of the last step; converged unless the run failed
  RunSummary summary;
  double seconds = 0;       ///< of the wall clock
  bool is_accurate = true;  ///< false where an accuracy was asked for and not met
  std::string scheme = {};  ///< that ran, where it is not the simulation's own
};

/// Where what happened is told: not among the results.
std::FILE* report_stream(const SimulateArguments& arguments);

bool is_bag(const std::string& path);

/// Writes rows by a thread of its own; at each of them the summary, which must outlive it, looks, too. Null: nothing is
/// put out.
/// @throws InputError naming what of the output or the columns is wrong.
std::unique_ptr<ResultWriter> open_output(const SimulateArguments& arguments, const Simulation& simulation,
                                          RunSummary& summary);

}  // namespace flexarm::cli
