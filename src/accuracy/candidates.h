#pragma once
/// Combinations of meshes, schemes and steps, whose errors and costs follow from those of their parts.

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
  int parts = 1;       ///< steps of an interval
  double error = 0;    ///< predicted, relative to the largest displacement
  double seconds = 0;  ///< of the processor for the whole run, predicted
};

/// What was measured of meshes and of steps. Errors are small differences of motions: those of a mesh and of a step
/// add up as vectors. A sum that is smaller than its larger part is taken for that: that they cancel is luck.
class CandidatePool {
 public:
  CandidatePool() = default;
  /// `runs`: from which the cost of an iteration follows. `scale`: largest displacement [m].
  CandidatePool(MeshErrors meshes, std::vector<StepErrors> steps, const std::deque<TrialRun>& runs, double scale,
                int intervals);

  /// For each mesh and scheme the longest step that keeps the accuracy, the cheapest first.
  std::vector<Candidate> cheapest(double accuracy) const;
  /// For each mesh and scheme the shortest step that takes no longer than that, the most accurate first.
  std::vector<Candidate> most_accurate(double seconds) const;
  /// The richest mesh with the scheme and the step that keep the accuracy at the least cost; the finest if none does.
  Candidate reference(double accuracy) const;
  /// Infinite: of what these settings are made was not measured.
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
  double fixed_ = 0, per_cost_ = 0;  // seconds of an iteration: that of the rest, and of a unit of mesh_cost()
};

/// Numbers of steps in an interval that are tried, each some ten per cent larger than the one before.
const std::vector<int>& step_parts();

}  // namespace flexarm
