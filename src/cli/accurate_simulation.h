#pragma once
/// `flexarm simulate --accuracy`.

#include "cli/simulation_output.h"

namespace flexarm::cli {

/// What is asked for, by an argument or by the scene; none: a run in equal steps.
std::optional<double> wanted_accuracy(const SimulateArguments& arguments, const Simulation& simulation);

/// Runs in steps that are chosen for an accuracy; the output has the rows of the last try. Says on the standard error
/// output where the accuracy was not met.
/// @throws InputError if arguments contradict each other, std::runtime_error if results cannot be written.
Run run_accurately(SimulateArguments arguments, double accuracy, Simulation& simulation);

}  // namespace flexarm::cli
