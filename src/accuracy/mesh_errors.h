#pragma once
/// What error does each beam's mesh make in the judged motion? Of two runs that differ in one beam's mesh alone the
/// difference is that beam's: hierarchical estimates, measured where they matter.

#include <optional>
#include <string>
#include <vector>

#include "accuracy/trial_runs.h"

namespace flexarm {

/// A beam's mesh, what it does to the motion, and what it costs.
struct MeshError {
  BeamResolution mesh;
  MotionDifference error;
  double cost = 0;  ///< of an iteration, in elements of order 1
};

struct MeshErrors {
  RunSettings rich;                           ///< the settings about which all errors are
  double rest = 0;                            ///< how far the rich mesh is from one twice as fine [m]
  bool is_rich_enough = false;                ///< that is small
  std::vector<std::vector<MeshError>> beams;  ///< of each beam, all meshes that were measured, cheapest first
  std::string shortcoming;                    ///< why the rich mesh is not rich enough

  /// Error of the meshes of all beams together [m]. Empty if one of them was not measured.
  std::optional<MotionDifference> of(const std::vector<BeamResolution>& meshes) const;
};

/// Meshes for all beams at once: what they do together and cost.
struct MeshChoice {
  std::vector<BeamResolution> beams;
  MotionDifference error;
  double cost = 0;
};

/// Cost of a beam's iteration, in elements of order 1 (docs/reports/speed.md, "Cost of an iteration").
double mesh_cost(const BeamResolution& mesh);
double mesh_cost(const std::vector<BeamResolution>& beams);

/// Which beams a search may change: those that are fixed keep their mesh.
struct MeshFreedom {
  std::vector<bool> is_free;  ///< of each beam
  bool may_be_rigid = false;
  bool keeps_orders = false;  ///< only the number of elements changes
};

/// Measures meshes of each free beam up to those whose error is at most `wanted` [m], with the scheme, step and
/// tolerance of `settings`: their errors in time cancel. The rich mesh is refined until it is `wanted` from one twice
/// as fine.
/// @throws SearchEnded
MeshErrors measure_meshes(TrialRuns& trials, const RunSettings& settings, const MeshFreedom& freedom, double wanted);

/// Meshes from the cheapest to the best: each time the beam is refined that gains most for its cost. Meshes that are no
/// better than a cheaper one are left out.
std::vector<MeshChoice> mesh_choices(const MeshErrors& errors);

/// The cheapest of them whose error is at most `wanted` [m]; the best if none is.
const MeshChoice& cheapest_mesh(const std::vector<MeshChoice>& choices, double wanted);

}  // namespace flexarm
