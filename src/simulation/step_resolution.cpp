#include "simulation/step_resolution.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "math/picked.h"

namespace flexarm {
namespace {

/// Largest part of the accelerations that may be missing in a step. In a motion that is resolved, about half the phase
/// of the step is missing. But if an acceleration is 0 at one end of a step, half of that at the other end is missing,
/// however short the step is.
constexpr double kDoubtful = 0.75;
/// Accelerations that are negligible [m/s^2, rad/s^2].
constexpr double kStill = 1e-6;
/// Number of steps that are checked. An oscillation that steps do not resolve may look smooth over some of them.
constexpr int kSteps = 6;

/// The mass matrix of the states that are positions.
Eigen::MatrixXd mass_of_states(const LinearModel& model) {
  std::vector<Eigen::Index> places;
  for (int i = 0; i < model.positions; ++i) {
    const auto name = std::find(model.coordinates.begin(), model.coordinates.end(), model.states[i]);
    places.push_back(name - model.coordinates.begin());
  }
  return picked(model.mass, places, places);
}

/// Doubt about `model`, which belongs to `simulation`: `next` is the simulation one step later, and `after` its model.
std::string doubt_about_step(const Simulation& simulation, const LinearModel& model, const Simulation& next,
                             const LinearModel& after) {
  const Eigen::MatrixXd mass = mass_of_states(model);
  const auto size = [&](const Eigen::VectorXd& motion) { return std::sqrt(std::max(0.0, motion.dot(mass * motion))); };
  const Eigen::Index count = model.positions;
  const double step = next.time() - simulation.time();
  const Eigen::VectorXd made = (after.drift.head(count) - model.drift.head(count)) / step,
                        asked = model.drift.tail(count);
  const double most = std::max({size(made), size(asked), size(after.drift.tail(count))}), missing = size(made - asked);
  if (missing <= kDoubtful * most + kStill * std::sqrt(mass.trace())) return "";
  return fmt::format(
      "at {:.6g} s the forces require accelerations {:.2g} times those in the next step of {:.3g} s: the step does not "
      "resolve the motion of the beams, and the poles may be wrong; expected a shorter step of the <integrator>",
      simulation.time(), size(asked) / size(made), step);
}

}  // namespace

std::string doubt_about_instant(const Simulation& simulation, const LinearModel& model) {
  LinearRequest request;
  request.about = LinearisedAbout::Instant;
  request.inputs = model.inputs;
  request.outputs = model.outputs;
  Simulation here = simulation.copy();
  LinearModel of_here = model;
  for (int n = 0; n < kSteps; ++n) {
    Simulation next = here.copy();
    if (!next.step().converged) return "";
    const LinearModel after = linearise(next, request);
    if (after.states != of_here.states) return "";
    if (std::string doubt = doubt_about_step(here, of_here, next, after); !doubt.empty()) return doubt;
    of_here = after;
    here = std::move(next);
  }
  return "";
}

}  // namespace flexarm
