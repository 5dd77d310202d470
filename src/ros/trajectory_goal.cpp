#include "trajectory_goal.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flexarm::node {
namespace {

using Judgement = TrajectoryGoal::Judgement;

/// `violated` with the first joint that exceeds its tolerance, or `kept` if there is none.
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

std::string fault_of_tolerances(const std::vector<control::JointTolerance>& given,
                                const std::vector<std::string>& names) {
  for (const control::JointTolerance& tolerance : given) {
    if (std::find(names.begin(), names.end(), tolerance.name) == names.end())
      return "a tolerance is given for '" + tolerance.name + "', which the trajectory does not name";
    if (!std::isfinite(tolerance.position) || !std::isfinite(tolerance.velocity))
      return "a tolerance of '" + tolerance.name + "' is not finite";
  }
  return {};
}

std::vector<JointTolerance> tolerances_of(const std::vector<control::JointTolerance>& given,
                                          const std::vector<std::string>& joints) {
  std::vector<JointTolerance> tolerances(joints.size());
  for (const control::JointTolerance& tolerance : given)
    for (std::size_t k = 0; k < joints.size(); ++k)
      if (joints[k] == tolerance.name) tolerances[k] = {tolerance.position, tolerance.velocity};
  return tolerances;
}

Judgement TrajectoryGoal::judge(double time, const std::vector<JointPoint>& desired,
                                const std::vector<JointPoint>& actual) const {
  for (const std::size_t count : {path.size(), at_end.size(), desired.size(), actual.size()})
    if (count != joints.size())
      throw std::invalid_argument("a goal of " + std::to_string(joints.size()) + " joints has " +
                                  std::to_string(count) + " tolerances or points");
  if (time < end - kTimeRoundOff) return compared(path, desired, actual, Verdict::Underway, Verdict::OffPath);
  const bool has_time = time < end + patience - kTimeRoundOff;
  return compared(at_end, desired, actual, Verdict::Reached, has_time ? Verdict::Underway : Verdict::NotReached);
}

}  // namespace flexarm::node
