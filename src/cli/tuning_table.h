#pragma once
/// What a search for settings has found, for people and for other programs.

#include <string>

#include "accuracy/tuning.h"

namespace flexarm::cli {

/// A line for each run than which none is both faster and more accurate, for the scene as it stands, for the reference.
std::string tuning_table(const TuningResult& result, const JudgedTimes& times);
/// All runs: role (best, scene, reference, run), mesh, scheme, step, tolerance, unknowns, steps, iterations, seconds,
/// times_real_time, error, failure.
std::string tuning_csv(const TuningResult& result, const JudgedTimes& times);

}  // namespace flexarm::cli
