#include "study_schemes/initial_accelerations.h"

#include "integrators/stepper.h"

namespace flexarm {

StepResult find_accelerations(const Model& model, const StepSettings& of_step, State& state) {
  // A difference quotient over a step h has a truncation error of order h and a round-off error of order epsilon / h^2.
  const double h = 1e-2 * of_step.step;
  StepSettings settings = of_step;
  settings.step = h;
  settings.events = {};
  Scheme scheme = *find_scheme("m1");
  scheme.heeds_slide_schemes = false;  // the slides' schemes were chosen for another scheme
  Stepper momentum(model, scheme, settings);
  State moved = state;
  StepResult result = momentum.advance(moved);
  if (!result.converged) return result;
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    state.nodes[i].acceleration = (moved.nodes[i].velocity - state.nodes[i].velocity) / h;
    state.nodes[i].angular_acceleration = (moved.nodes[i].angular_velocity - state.nodes[i].angular_velocity) / h;
  }
  for (std::size_t i = 0; i < state.study.mass_points.size(); ++i)
    state.study.mass_points[i].angular_acceleration =
        (moved.study.mass_points[i].angular_velocity - state.study.mass_points[i].angular_velocity) / h;
  for (std::size_t i = 0; i < state.actuators.size(); ++i) {
    state.actuators[i].acceleration = (moved.actuators[i].rate - state.actuators[i].rate) / h;
    // The work of the first step uses the motor's effort at both ends. The effort at the start is the one that caused
    // these accelerations.
    const int coordinate = model.actuators[i].coordinate;
    if (model.coordinates[coordinate].motion < 0) state.efforts[coordinate] = moved.efforts[coordinate];
  }
  return result;
}

}  // namespace flexarm
