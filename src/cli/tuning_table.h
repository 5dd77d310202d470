#pragma once
/// Prints the results of a search for settings, as a table or as CSV.

#include <string>

#include "accuracy/tuning.h"

namespace flexarm::cli {

/// A line for each run on the Pareto front (no other run is both faster and at least as accurate), for the scene's own
/// settings, and for the reference.
std::string tuning_table(const TuningResult& result, const JudgedTimes& times);
/// All runs, with the columns role (best, scene, reference, run), mesh, scheme, step, tolerance, unknowns, steps,
/// iterations, seconds, times_real_time, error, failure.
std::string tuning_csv(const TuningResult& result, const JudgedTimes& times);

}  // namespace flexarm::cli
