#include "flexarm/model/results.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "math/pi.h"

namespace flexarm {

const char* to_string(ServoMode mode) {
  return mode == ServoMode::Effort ? "effort" : mode == ServoMode::Velocity ? "velocity" : "position";
}

std::optional<ServoMode> servo_mode_called(std::string_view name) {
  for (const ServoMode mode : {ServoMode::Effort, ServoMode::Velocity, ServoMode::Position})
    if (name == to_string(mode)) return mode;
  return std::nullopt;
}

const char* to_string(StepResult::Reason reason) {
  switch (reason) {
    case StepResult::Reason::None:
      return "none";
    case StepResult::Reason::NoConvergence:
      return "Newton's method did not converge";
    case StepResult::Reason::SingularTangent:
      return "the tangent is singular";
    case StepResult::Reason::NotFinite:
      return "a quantity is not finite";
    case StepResult::Reason::RotationTooLarge:
      return "a node turns by more than 90 degrees in one step";
    case StepResult::Reason::OffTheLine:
      return "a slider leaves its line, or passes too many elements in one step";
    case StepResult::Reason::DrivenOffTheLine:
      return "a motion drives a slider beyond the end of its line";
    case StepResult::Reason::HitTooFast:
      return "a stop is hit too fast for the step";
    case StepResult::Reason::EventWithin:
      return "something sticks, slips, hits or leaves within the step";
    case StepResult::Reason::OpenLoop:
      return "a loop joint opens: its loop was singular at the start, or more is prescribed than the loop allows";
    case StepResult::Reason::NeverRests:
      return "the loads move it without limit: nothing holds it";
    case StepResult::Reason::BentTooFar:
      return "an element is bent by nearly a turn, or more, between its nodes";
    case StepResult::Reason::DeadPoint:
      return "a loop reaches a dead point: a prescribed motion goes beyond it, or the loop can move on in more than "
             "one way";
    case StepResult::Reason::OutOfTime:
      return "the step exceeds its limit of wall time";
  }
  return "unknown";
}

void StepResult::add_effort(const StepResult& other) {
  iterations += other.iterations;
  factorisations += other.factorisations;
  halvings += other.halvings;
  other_guesses += other.other_guesses;
  deepest_halving = std::max(deepest_halving, other.deepest_halving);
  is_dissipated = is_dissipated || other.is_dissipated;
  if (other.largest_rotation <= largest_rotation) return;
  largest_rotation = other.largest_rotation;
  turning_node = other.turning_node;
}

void StepCounts::add(const StepResult& result) {
  ++steps;
  iterations += result.iterations;
  halvings += result.halvings;
  other_guesses += result.other_guesses;
  dissipated_steps += result.is_dissipated;
  deepest_halving = std::max(deepest_halving, result.deepest_halving);
  if (!std::isnan(result.error_estimate)) error_estimate = result.error_estimate;
}

std::string recoveries_text(const StepCounts& counts) {
  std::vector<std::string> texts;
  if (counts.deepest_halving > 0)
    texts.push_back(fmt::format("{} halvings (down to 1/{} of a step)", counts.halvings,
                                std::int64_t{1} << counts.deepest_halving));
  if (counts.other_guesses > 0)
    texts.push_back(fmt::format("{} sub-steps from another initial guess", counts.other_guesses));
  if (counts.dissipated_steps > 0) texts.push_back(fmt::format("{} steps by edmc2", counts.dissipated_steps));
  return fmt::format("{}", fmt::join(texts, ", "));
}

double edge_strain(const BeamPoint& point, double radius) {
  const Vector3 gamma = point.strain.head<3>(), curvature = point.strain.tail<3>();
  const double normal = std::abs(gamma.x()) + radius * curvature.tail<2>().norm();
  const double shear = gamma.tail<2>().norm() + radius * std::abs(curvature.x());
  return std::hypot(normal, shear / std::sqrt(3.0));
}

double Mode::damping_ratio() const {
  return rate == 0 ? 0 : -rate / std::hypot(2 * kPi * frequency, rate);
}

}  // namespace flexarm
