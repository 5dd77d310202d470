#pragma once
/// Meshes for elements="auto" and a requested accuracy: as few elements as keep it, beam by beam.

#include <functional>
#include <string>

#include "accuracy/trial_runs.h"

namespace flexarm {

/// The part of an accuracy that is for the error of meshes, if meshes are chosen for it; the rest is for that of the
/// steps.
constexpr double kMeshShare = 0.5;

struct AutomaticMeshes {
  RunSettings settings;     ///< the scene's, with a number of elements for each beam that asks for "auto"; 0: rigid
  bool is_chosen = false;   ///< else they still ask for it: nothing was found
  double error = 0;         ///< what the meshes of these do together, as estimated, relative
  bool is_met = false;      ///< that is as small as was asked for
  std::string shortcoming;  ///< why not
  int runs = 0;
  double seconds = 0;  ///< of the processor, of all of them

  /// What of an accuracy, of which meshes have had kMeshShare, is there for the steps.
  double left(double accuracy) const { return is_chosen ? (1 - kMeshShare) * accuracy : accuracy; }
};

/// Beams keep their order, and those with a number of elements keep that: what these err is not looked at. One whose
/// bending the points do not feel becomes rigid, unless it has what only an elastic one can have. Runs to the end of
/// `trials`' time measure the errors in the judged points (mesh_errors.h). Nothing runs where no beam asks for "auto".
/// `accuracy`: of space alone, relative to the largest displacement.
AutomaticMeshes automatic_meshes(TrialRuns& trials, double accuracy);

}  // namespace flexarm
