#pragma once
/// Meshes for elements="auto" and a requested accuracy: as few elements as keep it, beam by beam.

#include <functional>
#include <string>

#include "accuracy/trial_runs.h"

namespace flexarm {

/// Share of an accuracy for the errors of meshes, if meshes are chosen for it. The rest is for the errors of steps.
constexpr double kMeshShare = 0.5;

struct AutomaticMeshes {
  RunSettings settings;     ///< the scene's, with a number of elements for each beam that asks for "auto"; 0: rigid
  bool is_chosen = false;   ///< false: nothing was found, and the beams still ask for "auto"
  double error = 0;         ///< estimated error of all these meshes together, relative
  bool is_met = false;      ///< the error is as small as requested
  std::string shortcoming;  ///< why not
  int runs = 0;
  double seconds = 0;  ///< processor time of all runs

  /// The part of `accuracy` that remains for the steps, after meshes have had kMeshShare.
  double left(double accuracy) const { return is_chosen ? (1 - kMeshShare) * accuracy : accuracy; }
};

/// Chooses the number of elements of beams that ask for "auto". Beams keep their order. Beams with a given number of
/// elements keep it, and their errors are not considered. A beam becomes rigid if its bending does not move the judged
/// points, unless it has properties that only an elastic beam can have. The errors in the judged points are measured by
/// runs to the end of `trials`' time (mesh_errors.h). Makes no runs if no beam asks for "auto". `accuracy`: for errors
/// of meshes alone, relative to the largest displacement.
AutomaticMeshes automatic_meshes(TrialRuns& trials, double accuracy);

}  // namespace flexarm
