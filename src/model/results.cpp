#include "flexarm/model/results.h"

#include <cmath>

#include "math/pi.h"

namespace flexarm {

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
    case StepResult::Reason::OpenLoop:
      return "a loop joint opens: its loop was singular at the start, or more is prescribed than the loop allows";
    case StepResult::Reason::BentTooFar:
      return "an element is bent by nearly two turns, or more, within itself";
    case StepResult::Reason::EnergyDefect:
      return "the step's energy defect is too large to be closed by scaling the velocities";
  }
  return "unknown";
}

double Mode::damping_ratio() const {
  return rate == 0 ? 0 : -rate / std::hypot(2 * kPi * frequency, rate);
}

}  // namespace flexarm
