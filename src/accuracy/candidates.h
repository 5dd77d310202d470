#pragma once
/// Combinations of meshes, schemes and steps, whose errors and costs are predicted from those of the parts.

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/mesh_errors.h"
#include "accuracy/step_errors.h"

namespace flexarm {

struct Candidate {
  std::vector<BeamResolution> beams;
  std::string scheme;
  int parts = 1;       ///< steps in an interval
  double error = 0;    ///< predicted, relative to the largest displacement
  double seconds = 0;  ///< predicted processor time of the whole run
};

/// Predicts errors and costs from what was measured of meshes and of steps. Errors are small differences of motions, so
/// those of a mesh and of a step add up as vectors. If their sum is smaller than its larger part, the larger part
/// counts: that they cancel is luck.
class CandidatePool {
 public:
  CandidatePool() = default;
  /// `runs`: give the cost of an iteration. `scale`: largest displacement [m].
  CandidatePool(MeshErrors meshes, std::vector<StepErrors> steps, const std::deque<TrialRun>& runs, double scale,
                int intervals);

  /// For each mesh and scheme, the longest step that keeps the accuracy. The cheapest candidate comes first.
  std::vector<Candidate> cheapest(double accuracy) const;
  /// For each mesh and scheme, the shortest step with which the run takes at most `seconds`. The most accurate
  /// candidate comes first.
  std::vector<Candidate> most_accurate(double seconds) const;
  /// The richest mesh, with the scheme and step that keep the accuracy at the least cost. If none does, with the most
  /// accurate.
  Candidate reference(double accuracy) const;
  /// Predicted relative error of a run. Infinite if its meshes or its steps were not measured.
  double predicted_error(const RunSettings& settings, const JudgedTimes& times) const;
  double scale() const { return scale_; }

 private:
  Candidate candidate(const MeshChoice& mesh, const StepErrors& steps, int parts) const;
  void fit_cost(const std::deque<TrialRun>& runs);

  MeshErrors mesh_errors_;
  std::vector<MeshChoice> meshes_;
  std::vector<StepErrors> steps_;
  double scale_ = 1;
  int intervals_ = 1;
  double fixed_ = 0, per_cost_ = 0;  // seconds of an iteration: a fixed part, and per unit of mesh_cost()
};

/// Numbers of steps in an interval that are considered. Each is about ten per cent larger than the one before.
const std::vector<int>& step_parts();

}  // namespace flexarm
