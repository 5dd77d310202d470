#include "accuracy/candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "schemes/scheme.h"

namespace flexarm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Size of the error of a mesh and a step together [m]. Infinite if the error of the step is unknown.
double together(const MotionDifference& mesh, const MotionDifference& step) {
  if (step.size() == 0) return kInfinity;
  if (mesh.size() == 0) return size(step);
  return std::max({size(MotionDifference(mesh + step)), size(mesh), size(step)});
}

/// Whether an iteration is a step of an explicit scheme, not one of Newton's method.
bool is_explicit(const RunSettings& settings) {
  return find_scheme(settings.scheme)->tableau != nullptr;
}

}  // namespace

const std::vector<int>& step_parts() {
  static const std::vector<int> parts = [] {
    std::vector<int> out;
    for (double next = 1; next < 1 << 15; next = std::max(next + 1, std::ceil(1.1 * next)))
      out.push_back(static_cast<int>(next));
    return out;
  }();
  return parts;
}

CandidatePool::CandidatePool(MeshErrors meshes, std::vector<StepErrors> steps, const std::deque<TrialRun>& runs,
                             double scale, int intervals)
    : mesh_errors_(std::move(meshes)),
      meshes_(mesh_choices(mesh_errors_)),
      steps_(std::move(steps)),
      scale_(scale),
      intervals_(intervals) {
  fit_cost(runs);
}

/// Fits the cost of an iteration of Newton's method by least squares of relative deviations. Neither part becomes
/// negative.
void CandidatePool::fit_cost(const std::deque<TrialRun>& runs) {
  double aa = 0, ab = 0, bb = 0, ay = 0, by = 0;
  for (const TrialRun& run : runs) {
    if (!run.is_complete() || !(run.seconds > 0) || run.iterations == 0 || is_explicit(run.settings)) continue;
    const double y = run.seconds / static_cast<double>(run.iterations), a = 1 / y,
                 b = mesh_cost(run.settings.beams) / y;
    aa += a * a, ab += a * b, bb += b * b, ay += a, by += b;
  }
  const double determinant = aa * bb - ab * ab;
  if (determinant > 1e-9 * aa * bb) {
    fixed_ = (ay * bb - by * ab) / determinant;
    per_cost_ = (by * aa - ay * ab) / determinant;
  }
  if (!(fixed_ > 0 && per_cost_ >= 0)) fixed_ = bb > 0 ? 0 : ay / aa, per_cost_ = bb > 0 ? by / bb : 0;
}

Candidate CandidatePool::candidate(const MeshChoice& mesh, const StepErrors& steps, int parts) const {
  const double iterations = intervals_ * parts * steps.iterations_per_step(parts);
  const double of_one = is_explicit(steps.settings) ? steps.seconds_per_iteration() : fixed_ + per_cost_ * mesh.cost;
  return {mesh.beams, steps.settings.scheme, parts, together(mesh.error, steps.at(parts)) / scale_,
          iterations * of_one};
}

std::vector<Candidate> CandidatePool::cheapest(double accuracy) const {
  std::vector<Candidate> found;
  for (const MeshChoice& mesh : meshes_) {
    if (mesh.error.size() > 0 && size(mesh.error) > accuracy * scale_) continue;
    for (const StepErrors& steps : steps_)
      for (const int parts : step_parts()) {
        const Candidate next = candidate(mesh, steps, parts);
        if (next.error > accuracy) continue;
        found.push_back(next);
        break;
      }
  }
  std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) { return a.seconds < b.seconds; });
  return found;
}

std::vector<Candidate> CandidatePool::most_accurate(double seconds) const {
  std::vector<Candidate> found;
  for (const MeshChoice& mesh : meshes_)
    for (const StepErrors& steps : steps_) {
      std::optional<Candidate> last;
      for (const int parts : step_parts()) {
        const Candidate next = candidate(mesh, steps, parts);
        if (next.seconds > seconds) break;
        if (next.error < kInfinity) last = next;
      }
      if (last) found.push_back(*last);
    }
  std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) { return a.error < b.error; });
  return found;
}

Candidate CandidatePool::reference(double accuracy) const {
  const std::vector<BeamResolution>& beams = mesh_errors_.rich.beams;
  const MeshChoice rich{beams, {}, mesh_cost(beams)};
  std::optional<Candidate> best;
  for (const StepErrors& steps : steps_)
    for (const int parts : step_parts()) {
      const Candidate next = candidate(rich, steps, parts);
      if (next.error == kInfinity) continue;
      const bool is_enough = next.error <= accuracy;
      if (!best || (best->error > accuracy ? next.error < best->error : is_enough && next.seconds < best->seconds))
        best = next;
      if (is_enough || parts >= 4 * steps.parts.back()) break;
    }
  return best.value_or(Candidate{beams, steps_.empty() ? "auto" : steps_.front().settings.scheme, 1, kInfinity, 0});
}

double CandidatePool::predicted_error(const RunSettings& settings, const JudgedTimes& times) const {
  const int parts = static_cast<int>(std::lround(times.interval / settings.step));
  const std::optional<MotionDifference> error = mesh_errors_.of(settings.beams);
  if (!error) return kInfinity;
  for (const StepErrors& steps : steps_)
    if (steps.settings.scheme == settings.scheme) return candidate({settings.beams, *error, 0}, steps, parts).error;
  return kInfinity;
}

}  // namespace flexarm
