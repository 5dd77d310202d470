#pragma once
/// Neighbours of a simulation: with other values of a parameter, or with another start.

#include <memory>
#include <string>
#include <vector>

#include "flexarm/simulation/sensitivities.h"
#include "integrators/neighbour_steps.h"

namespace flexarm {

/// A parameter, and the neighbours that have other values of it.
class ParameterDirection {
 public:
  /// The simulation and the request must outlive this.
  /// @throws std::invalid_argument as Sensitivities does.
  ParameterDirection(const Simulation& simulation, const SensitivityRequest& request, const std::string& name);

  /// Neighbours at the start, with its derivative by the parameter.
  Direction start(NeighbourSteps& steps);
  /// Puts neighbours that have gone too far off the run, in `state`, closer to it.
  void come_closer(NeighbourSteps& steps, Direction& direction, const State& state);
  /// Of the neighbours in their order, to be looked at.
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
  IntegratorDescription integrator_;             // as it is read
  std::vector<std::pair<double, double>> rule_;  // offsets and weights of the neighbours
  std::vector<Simulation> looks_;
};

/// For the state at the start of the simulation: neighbours whose start differs by one state of linear models each.
std::vector<Direction> initial_state_directions(const Simulation& simulation, NeighbourSteps& steps,
                                                std::vector<std::string>& names);

}  // namespace flexarm
