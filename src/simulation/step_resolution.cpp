#include "simulation/step_resolution.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "math/picked.h"

namespace flexarm {
namespace {

/// Half the phase of a step, above which it is doubtful. Where a wave's acceleration is 0 at one end of the step, a
/// half of that at the other is missing, however short it is.
constexpr double kDoubtful = 0.75;
/// Accelerations that matter to nobody [m/s^2, rad/s^2].
constexpr double kStill = 1e-6;
/// That are looked at.
constexpr int kSteps = 2;

/// Of the states that are positions.
Eigen::MatrixXd mass_of_states(const LinearModel& model) {
  std::vector<Eigen::Index> places;
  for (int i = 0; i < model.positions; ++i) {
    const auto name = std::find(model.coordinates.begin(), model.coordinates.end(), model.states[i]);
    places.push_back(name - model.coordinates.begin());
  }
  return picked(model.mass, places, places);
}

/// About `model` of `simulation`, by the step from there to `next` and the model `after` it.
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
      "at {:.6g} s forces ask for accelerations {:.2g} times those that the next step of {:.3g} s makes: it does not "
      "resolve "
      "what the beams do there, and the poles may be wrong; expected a shorter step of the <integrator>",
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
  // What rings may pass one step unseen.
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
