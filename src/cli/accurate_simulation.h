#pragma once
/// Runs `flexarm simulate --accuracy`.

#include "cli/simulation_output.h"

namespace flexarm::cli {

/// The accuracy that the arguments or the scene ask for; empty: none, so the run has equal steps.
std::optional<double> wanted_accuracy(const SimulateArguments& arguments, const Simulation& simulation);

/// A line on how far energy has drifted in the run of an explicit scheme; empty for other schemes. `drift`: relative,
/// see RunSummary.
std::string drift_text(const std::string& scheme, double drift);

/// Runs with steps that are chosen for an accuracy. The output contains the rows of the last try. Says on standard
/// error if the accuracy was not met.
/// @throws InputError if arguments contradict each other, std::runtime_error if results cannot be written
Run run_accurately(SimulateArguments arguments, double accuracy, Simulation& simulation);

}  // namespace flexarm::cli
