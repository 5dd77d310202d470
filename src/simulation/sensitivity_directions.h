#pragma once
/// Neighbours of a simulation: the same mechanism with another value of a parameter, or with another start.

#include <memory>
#include <string>
#include <vector>

#include "flexarm/simulation/sensitivities.h"
#include "integrators/neighbour_steps.h"

namespace flexarm {

/// A parameter by which a run is differentiated, and the neighbours that have other values of it.
class ParameterDirection {
 public:
  /// The simulation and the request must outlive this.
  /// @throws std::invalid_argument as Sensitivities does.
  ParameterDirection(const Simulation& simulation, const SensitivityRequest& request, const std::string& name);

  /// Makes the neighbours at the start, and the derivative of the start by the parameter.
  Direction start(NeighbourSteps& steps);
  /// Places neighbours that are too far from the run, which is in `state`, closer to it.
  void come_closer(NeighbourSteps& steps, Direction& direction, const State& state);
  /// The simulation with the model of a neighbour, to read results from.
  Simulation& look(std::size_t neighbour) { return looks_[neighbour]; }

 private:
  struct Attempt;
  Attempt attempt(double value) const;
  Simulation built(double value) const;
  void choose_side();
  void set_neighbours(Direction& direction);
  std::vector<double> derivative_at_start(NeighbourSteps& steps) const;

  const Simulation& simulation_;
  const SensitivityRequest& request_;
  std::string name_;
  double value_ = 0, scale_ = 1;                 // of the parameter
  IntegratorDescription integrator_;             // as read from the scene
  std::vector<std::pair<double, double>> rule_;  // offsets and weights of the neighbours
  std::vector<Simulation> looks_;
};

/// Directions for derivatives by the initial state, one for each state of the linear model at the start. Appends the
/// states' names to `names`.
std::vector<Direction> initial_state_directions(const Simulation& simulation, NeighbourSteps& steps,
                                                std::vector<std::string>& names);

}  // namespace flexarm
