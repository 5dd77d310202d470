#pragma once
/// Measures the error that each beam's mesh makes in the judged motion. If two runs differ in the mesh of one beam
/// alone, their difference is the error of that mesh (a hierarchical estimate, which counts only what moves the judged
/// points).

#include <optional>
#include <string>
#include <vector>

#include "accuracy/trial_runs.h"

namespace flexarm {

/// A mesh of a beam, its error in the motion, and its cost.
struct MeshError {
  BeamResolution mesh;
  MotionDifference error;
  double cost = 0;  ///< of an iteration; the unit is an element of order 1
};

struct MeshErrors {
  RunSettings rich;                           ///< the settings to which all errors are relative
  double rest = 0;                            ///< how far the rich mesh is from one twice as fine [m]
  bool is_rich_enough = false;                ///< `rest` is small
  std::vector<std::vector<MeshError>> beams;  ///< for each beam, all measured meshes, cheapest first
  std::string shortcoming;                    ///< why the rich mesh is not rich enough

  /// Error of the meshes of all beams together [m]. Empty if one of them was not measured.
  std::optional<MotionDifference> of(const std::vector<BeamResolution>& meshes) const;
};

/// Meshes for all beams, with their common error and cost.
struct MeshChoice {
  std::vector<BeamResolution> beams;
  MotionDifference error;
  double cost = 0;
};

/// Cost of an iteration for a beam; the unit is an element of order 1 (docs/reports/speed.md, "Cost of an iteration").
double mesh_cost(const BeamResolution& mesh);
double mesh_cost(const std::vector<BeamResolution>& beams);

/// Which beams a search may change. The others keep their mesh.
struct MeshFreedom {
  std::vector<bool> is_free;  ///< of each beam
  bool may_be_rigid = false;
  bool keeps_orders = false;  ///< only the number of elements changes
};

/// Measures meshes of each free beam, up to those whose error is at most `wanted` [m]. All runs have the scheme, step
/// and tolerance of `settings`, so that errors in time cancel. The rich mesh is refined until it differs by at most
/// `wanted` from a mesh twice as fine.
/// @throws SearchEnded
MeshErrors measure_meshes(TrialRuns& trials, const RunSettings& settings, const MeshFreedom& freedom, double wanted);

/// Choices of meshes from the cheapest to the best. From one to the next, the beam is refined that gains most for its
/// cost. Meshes that are no better than a cheaper one are left out.
std::vector<MeshChoice> mesh_choices(const MeshErrors& errors);

/// The cheapest choice whose error is at most `wanted` [m]; the best if none is.
const MeshChoice& cheapest_mesh(const std::vector<MeshChoice>& choices, double wanted);

}  // namespace flexarm
