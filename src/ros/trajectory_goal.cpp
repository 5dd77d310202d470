#include "trajectory_goal.h"

#include <cmath>

namespace flexarm::node {
namespace {

using Judgement = TrajectoryGoal::Judgement;

/// The first joint beyond its tolerance makes it `violated`; else it is `kept`.
Judgement compared(const std::vector<JointTolerance>& tolerances, const std::vector<JointPoint>& desired,
                   const std::vector<JointPoint>& actual, TrajectoryGoal::Verdict kept,
                   TrajectoryGoal::Verdict violated) {
  for (std::size_t k = 0; k < tolerances.size(); ++k) {
    const double position = std::abs(desired[k].position - actual[k].position);
    const double velocity = std::abs(desired[k].velocity - actual[k].velocity);
    const JointTolerance& allowed = tolerances[k];
    if (allowed.position > 0 && position > allowed.position)
      return {violated, k, "position", position, allowed.position};
    if (allowed.velocity > 0 && velocity > allowed.velocity)
      return {violated, k, "velocity", velocity, allowed.velocity};
  }
  return {kept};
}

}  // namespace

Judgement TrajectoryGoal::judge(double time, const std::vector<JointPoint>& desired,
                                const std::vector<JointPoint>& actual) const {
  if (time < end - kTimeRoundOff) return compared(path, desired, actual, Verdict::Underway, Verdict::OffPath);
  const bool has_time = time < end + patience - kTimeRoundOff;
  return compared(at_end, desired, actual, Verdict::Reached, has_time ? Verdict::Underway : Verdict::NotReached);
}

}  // namespace flexarm::node
